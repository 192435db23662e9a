#include "recording/merge/common_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/int128.h"
#include "recording/merge/stored_log.h"
#include "recording/records/every.h"
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
template <class... Instants> void rescale_all(const CommonTime& time, Instants&... instants) {
  (rescale(time, instants), ...);
}

// Rescales all instants of true time that a record holds.
void put_on(const CommonTime& time, records::Measured& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::CanFrameSent& r) { rescale_all(time, r.start, r.end); }
void put_on(const CommonTime& time, records::CanErrorFrame& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::CanStateChanged& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::SlotFrameSent& r) { rescale_all(time, r.stamp, r.end); }
void put_on(const CommonTime& time, records::SlotProblem& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::ListHop& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::TaskRun& r) { rescale_all(time, r.activated, r.start, r.end); }
void put_on(const CommonTime& time, records::ClockCorrected& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::PrecisionSample& r) { rescale_all(time, r.at); }
void put_on(const CommonTime& time, records::FusionInput& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::OdometryTaken& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::ListFused& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::FusionStep& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::TrackState& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::ObservationSeen& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::ImageWritten& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::FeatureUsed& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::ReferenceFix& r) { rescale_all(time, r.measured_true); }
void put_on(const CommonTime& time, records::TruthState& r) { rescale_all(time, r.at); }
void put_on(const CommonTime& time, records::EgoTruth& r) { rescale_all(time, r.at); }
void put_on(const CommonTime& time, records::Warning& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::CommandIssued& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::CommandTaken& r) { rescale_all(time, r.stamp, r.from); }
void put_on(const CommonTime& time, records::DetectionMade& r) { rescale_all(time, r.stamp, r.begin); }
void put_on(const CommonTime& time, records::SequencePlanned& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::PlanMade& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::StateChanged& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::SymbolSent& r) { rescale_all(time, r.stamp, r.end); }
void put_on(const CommonTime& time, records::PowerChanged& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::FaultActivity& r) { rescale_all(time, r.at); }
void put_on(const CommonTime& time, records::GuardianIntervention& r) { rescale_all(time, r.at, r.until); }
void put_on(const CommonTime& time, records::ChannelFrame& r) {
  if (r.slot == 0)
    rescale_all(time, r.start, r.end);  // no controller sent it
  else
    rescale_all(time, r.start, r.end, r.sent);
}
void put_on(const CommonTime& time, records::TimingProblem& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::LatenessHistogram& r) { rescale_all(time, r.stamp); }
void put_on(const CommonTime& time, records::MediumCounts& r) { rescale_all(time, r.stamp); }

class OnCommonTime final : public records::Every<OnCommonTime> {
 public:
  OnCommonTime(const CommonTime& time, records::Sink& out) : time_(time), out_(out) {}

  template <class Record> void each(Record record) {
    static_assert(
        requires { put_on(time_, record); }, "a kind of record whose times the merge does not know");
    put_on(time_, record);
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
