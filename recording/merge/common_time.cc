#include "recording/merge/common_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/int128.h"
#include "recording/merge/stored_log.h"
#include "schedules/model/round.h"

namespace ttf::recording::merge {
namespace {

constexpr std::int64_t kLongestCycle_ns = 16'000'000;  // cCycleMax

TrueTime within_type(Int128 ns) {
  using Limits = std::numeric_limits<std::int64_t>;
  return {static_cast<std::int64_t>(std::clamp<Int128>(ns, Limits::min(), Limits::max()))};
}

// Stamps of one node, in the order of the host's clock.
using Stamps = std::vector<SyncStamp>;

// Of the node that has most; of the first of several.
Stamps most_of(const std::map<NodeId, Stamps>& nodes) {
  const auto most = std::max_element(nodes.begin(), nodes.end(),
                                     [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  if (most == nodes.end()) return {};
  Stamps stamps = most->second;
  std::stable_sort(stamps.begin(), stamps.end(), [](const SyncStamp& a, const SyncStamp& b) { return a.at < b.at; });
  return stamps;
}

// How many rounds `behind` is, rounded; none where it is not known how long a round is.
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
      round_ns = log.info().manifest.cycle_ns * schedules::model::kCycles;
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
      warnings.push_back(fmt::format("no node of host {} was synchronised: its logs' times are its own clock's", host));
    else
      by_host[host] = CommonTime(points_of(of_host, reference->at.ns - reference->global.ns, round_ns));
  }
  for (std::size_t i = 0; i < logs.size(); ++i)
    if (logs[i].info().manifest.clock == log::kWallClock) times[i] = by_host[logs[i].info().manifest.host];
  return times;
}

template <class Record, class... Members> void OnCommonTime::pass(Record record, Members... times) const {
  (put(record.*times), ...);
  out_.on(record);
}

void OnCommonTime::on(const records::Measured& r) { pass(r, &records::Measured::stamp); }
void OnCommonTime::on(const records::CanFrameSent& r) {
  pass(r, &records::CanFrameSent::start, &records::CanFrameSent::end);
}
void OnCommonTime::on(const records::SlotFrameSent& r) {
  pass(r, &records::SlotFrameSent::stamp, &records::SlotFrameSent::end);
}
void OnCommonTime::on(const records::SlotProblem& r) { pass(r, &records::SlotProblem::stamp); }
void OnCommonTime::on(const records::ListHop& r) { pass(r, &records::ListHop::stamp); }
void OnCommonTime::on(const records::TaskRun& r) {
  pass(r, &records::TaskRun::activated, &records::TaskRun::start, &records::TaskRun::end);
}
void OnCommonTime::on(const records::ClockCorrected& r) { pass(r, &records::ClockCorrected::stamp); }
void OnCommonTime::on(const records::PrecisionSample& r) { pass(r, &records::PrecisionSample::at); }
void OnCommonTime::on(const records::FusionInput& r) { pass(r, &records::FusionInput::stamp); }
void OnCommonTime::on(const records::ListFused& r) { pass(r, &records::ListFused::stamp); }
void OnCommonTime::on(const records::FusionStep& r) { pass(r, &records::FusionStep::stamp); }
void OnCommonTime::on(const records::TrackState& r) { pass(r, &records::TrackState::stamp); }
void OnCommonTime::on(const records::ObservationSeen& r) { pass(r, &records::ObservationSeen::stamp); }
void OnCommonTime::on(const records::ImageWritten& r) { pass(r, &records::ImageWritten::stamp); }
void OnCommonTime::on(const records::FeatureUsed& r) { pass(r, &records::FeatureUsed::stamp); }
void OnCommonTime::on(const records::ReferenceFix& r) { pass(r, &records::ReferenceFix::measured_true); }
void OnCommonTime::on(const records::TruthState& r) { pass(r, &records::TruthState::at); }
void OnCommonTime::on(const records::StateChanged& r) { pass(r, &records::StateChanged::stamp); }
void OnCommonTime::on(const records::SymbolSent& r) { pass(r, &records::SymbolSent::stamp, &records::SymbolSent::end); }
void OnCommonTime::on(const records::PowerChanged& r) { pass(r, &records::PowerChanged::stamp); }
void OnCommonTime::on(const records::FaultActivity& r) { pass(r, &records::FaultActivity::at); }
void OnCommonTime::on(const records::GuardianIntervention& r) {
  pass(r, &records::GuardianIntervention::at, &records::GuardianIntervention::until);
}
void OnCommonTime::on(const records::ChannelFrame& r) {
  if (r.slot == 0)
    pass(r, &records::ChannelFrame::start, &records::ChannelFrame::end);  // no controller sent it
  else
    pass(r, &records::ChannelFrame::start, &records::ChannelFrame::end, &records::ChannelFrame::sent);
}
void OnCommonTime::on(const records::TimingProblem& r) { pass(r, &records::TimingProblem::stamp); }
void OnCommonTime::on(const records::LatenessHistogram& r) { pass(r, &records::LatenessHistogram::stamp); }
void OnCommonTime::on(const records::MediumCounts& r) { pass(r, &records::MediumCounts::stamp); }

}  // namespace ttf::recording::merge
