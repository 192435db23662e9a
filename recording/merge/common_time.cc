#include "recording/merge/common_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/int128.h"
#include "recording/merge/stored_log.h"
#include "recording/records/every.h"
#include "recording/records/fields.h"
#include "schedules/model/round.h"

namespace ttf::recording::merge {
namespace {

constexpr std::int64_t kLongestCycle_ns = 16'000'000;  // cCycleMax

TrueTime within_type(Int128 ns) {
  using Limits = std::numeric_limits<std::int64_t>;
  return {static_cast<std::int64_t>(std::clamp<Int128>(ns, Limits::min(), Limits::max()))};
}

// Stamps of one node, in the order of its machine's clock.
using Stamps = std::vector<SyncStamp>;

// Returns the stamps of the node with the most; of several such nodes, the first.
Stamps most_of(const std::map<NodeId, Stamps>& nodes) {
  const auto most = std::max_element(nodes.begin(), nodes.end(),
                                     [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  if (most == nodes.end()) return {};
  Stamps stamps = most->second;
  std::stable_sort(stamps.begin(), stamps.end(), [](const SyncStamp& a, const SyncStamp& b) { return a.at < b.at; });
  return stamps;
}

// Returns `behind` in whole rounds, rounded; 0 if the length of a round is unknown.
std::int64_t rounds_in(std::int64_t behind_ns, std::int64_t round_ns) {
  if (round_ns <= 0) return 0;
  const std::int64_t half = behind_ns < 0 ? -round_ns / 2 : round_ns / 2;
  return (behind_ns + half) / round_ns;
}

std::vector<CommonTime::Point> points_of(const Stamps& stamps, std::int64_t offset_ns, std::int64_t round_ns) {
  std::vector<CommonTime::Point> points;
  for (const SyncStamp& stamp : stamps) {
    const std::int64_t at = stamp.at.ns, shown = stamp.global.ns + offset_ns;
    const std::int64_t expected = points.empty() ? at : points.back().common.ns + (at - points.back().host.ns);
    const std::int64_t common = shown + rounds_in(expected - shown, round_ns) * round_ns;
    if (points.empty() || (at > points.back().host.ns && common > points.back().common.ns))
      points.push_back({stamp.at, TrueTime{common}});
  }
  return points;
}

void rescale(const CommonTime& time, TrueTime& at) { at = time(at); }
void rescale(const CommonTime& time, records::Stamp& stamp) { stamp.true_time = time(stamp.true_time); }
template <class Anything> void rescale(const CommonTime&, const Anything&) {}

class OnCommonTime final : public records::Every<OnCommonTime> {
 public:
  OnCommonTime(const CommonTime& time, records::Sink& out) : time_(time), out_(out) {}

  template <class Record> void each(Record record) {
    const TrueTime* kept = nullptr;
    if constexpr (std::is_same_v<Record, records::ChannelFrame>)
      if (record.slot == 0) kept = &record.sent;
    records::for_each_field<Record>([&](const auto& entry) {
      auto& member = record.*entry.member;
      if (static_cast<const void*>(&member) != kept) rescale(time_, member);
    });
    out_.on(record);
  }

 private:
  const CommonTime& time_;
  records::Sink& out_;
};

}  // namespace

TrueTime CommonTime::operator()(TrueTime host) const {
  if (points_.empty()) return host;
  const auto before_point = [](TrueTime t, const Point& point) { return t < point.host; };
  const auto after = std::upper_bound(points_.begin(), points_.end(), host, before_point);
  const Point& before = after == points_.begin() ? *after : *std::prev(after);
  const Int128 since = Int128{host.ns} - before.host.ns;
  if (after == points_.begin() || after == points_.end()) return within_type(before.common.ns + since);
  return within_type(before.common.ns + since * (after->common - before.common).ns / (after->host - before.host).ns);
}

std::vector<CommonTime> common_times(const std::vector<StoredLog>& logs, std::vector<std::string>& warnings) {
  std::map<std::string, std::map<NodeId, Stamps>> hosts;
  std::int64_t round_ns = 0;
  for (const StoredLog& log : logs) {
    if (log.info().manifest.clock != log::kWallClock) continue;
    if (log.info().manifest.cycle_ns > 0 && log.info().manifest.cycle_ns <= kLongestCycle_ns)
      round_ns = log.info().manifest.cycle_ns * log.info().manifest.cycles;
    auto& nodes = hosts[log.info().manifest.host];
    for (const SyncStamp& stamp : log.sync_stamps()) nodes[stamp.node].push_back(stamp);
  }
  std::vector<CommonTime> times(logs.size());
  if (hosts.size() < 2) return times;

  std::map<std::string, Stamps> stamps;
  std::optional<SyncStamp> reference;
  for (const auto& [host, nodes] : hosts) {
    stamps[host] = most_of(nodes);
    if (!stamps[host].empty() && (!reference || stamps[host].front().node < reference->node))
      reference = stamps[host].front();
  }
  std::map<std::string, CommonTime> by_host;
  for (const auto& [host, of_host] : stamps) {
    if (of_host.empty())
      warnings.push_back(
          fmt::format("no node of machine {} was synchronised: its logs keep the times of its own clock", host));
    else
      by_host[host] = CommonTime(points_of(of_host, reference->at.ns - reference->global.ns, round_ns));
  }
  for (std::size_t i = 0; i < logs.size(); ++i)
    if (logs[i].info().manifest.clock == log::kWallClock) times[i] = by_host[logs[i].info().manifest.host];
  return times;
}

std::unique_ptr<records::Sink> on_common_time(const CommonTime& time, records::Sink& out) {
  return std::make_unique<OnCommonTime>(time, out);
}

}  // namespace ttf::recording::merge
