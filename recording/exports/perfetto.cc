#include "recording/exports/perfetto.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "recording/records/enumerations.h"

namespace ttf::recording::exports {
namespace {

constexpr const char *kFlexRayGroup = "FlexRay", *kCanGroup = "CAN", *kFaultGroup = "faults";
constexpr Duration kKeptBack = MeasurementWays::kLongestWay + Duration::milliseconds(100);
constexpr std::size_t kImagesKept = 8;

// A damaged log may have any times; within 36 years arithmetic does not overflow.
constexpr std::int64_t kTraceReach_ns = std::int64_t{1} << 60;
constexpr bool within_reach(std::int64_t ns) { return ns >= -kTraceReach_ns && ns <= kTraceReach_ns; }
TrueTime shown(TrueTime at) { return {std::clamp<std::int64_t>(at.ns, 0, kTraceReach_ns)}; }

std::string channel_lane(std::uint8_t channel) { return channel == 0 ? "channel A" : "channel B"; }
std::string microseconds(Duration time) { return fmt::format("{:.1f} us", static_cast<double>(time.ns) * 1e-3); }

WayMark passed(const TraceMark& mark) { return {mark.at, mark.serial}; }
std::int64_t whole(std::uint64_t number) { return static_cast<std::int64_t>(number); }

}  // namespace

PerfettoExport::PerfettoExport(LogNames names, TraceTimeline::Write write)
    : names_(std::move(names)), ways_({[this](const MeasurementWays::Way& way) { join(way); }, {}}),
      timeline_(std::move(write), [this](const TraceMark& mark) { return flows_of(mark); }) {}

std::string PerfettoExport::measurement(const MeasurementId& id) const {
  return fmt::format("{} {}", names_.sensor(id.sensor), id.sequence);
}

// Advances the timeline. Records come in the order of time, so marks that are old enough are complete.
TrueTime PerfettoExport::come_to(TrueTime at) {
  const TrueTime now = shown(at);
  ways_.advance(now, [this](const MeasurementWays::Act& act, const WayMark& run) { on_act(act, run); });
  timeline_.write_before(now - kKeptBack);
  return now;
}

TraceCounts PerfettoExport::finish() {
  come_to(TrueTime{kTraceReach_ns});
  ways_.finish();
  timeline_.finish();
  return timeline_.counts();
}

// Joins the slices of a way by a flow. The flow of a measurement that was not fused ends where it was lost.
void PerfettoExport::join(const MeasurementWays::Way& way) {
  std::vector<WayMark> marks;
  for (const MeasurementWays::Stop& stop : way.stops)
    if (stop.mark && stop.deed != MeasurementWays::Deed::kRefused) marks.push_back(*stop.mark);
  if (!way.fused && way.lost) marks.push_back(*way.lost);
  std::ranges::sort(marks);
  marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
  if (marks.size() < 2) return;  // a flow needs two slices
  for (const WayMark& mark : marks) flows_[mark.serial].push_back({way.number, mark == marks.back()});
}

// Returns and forgets a mark's flows; they are complete once kLongestWay has passed since the mark.
std::vector<TraceFlow> PerfettoExport::flows_of(const TraceMark& mark) {
  const auto found = flows_.find(mark.serial);
  if (found == flows_.end()) return {};
  std::vector<TraceFlow> flows = std::move(found->second);
  flows_.erase(found);
  return flows;
}

// Notes an act in the slice of its task.
void PerfettoExport::on_act(const MeasurementWays::Act& act, const WayMark& run) {
  const TraceMark slice{run.at, run.serial};
  const auto note = [&](const char* name, const MeasurementId& id) { timeline_.note(slice, {name, measurement(id)}); };
  using Deed = MeasurementWays::Deed;
  switch (act.deed) {
    case Deed::kRead:
      for (const MeasurementId& id : act.ids) note("reads", id);
      break;
    case Deed::kWritten:
      for (const MeasurementId& id : act.ids) note("writes", id);
      break;
    case Deed::kHeld:
      for (const MeasurementId& id : act.ids) note("holds back", id);
      break;
    case Deed::kFused:
      for (const MeasurementId& id : act.ids) note("fuses", id);
      break;
    case Deed::kImage:
      timeline_.note(slice, {"writes image", std::int64_t{act.image}});
      for (const MeasurementId& id : act.ids) note("newest in the image", id);
      break;
    case Deed::kUsed: timeline_.note(slice, {"uses image", std::int64_t{act.image}}); break;
    case Deed::kMeasured:
    case Deed::kFrame:
    case Deed::kRefused:
    case Deed::kLost:
    case Deed::kImageFrame: break;
  }
}

TraceMark PerfettoExport::node_instant(NodeId node, const char* lane, TrueTime at, std::string name,
                                       std::vector<TraceNote> notes) {
  return timeline_.instant(names_.node(node), lane, come_to(at), std::move(name), std::move(notes));
}

void PerfettoExport::on(const records::Measured& r) {
  const TraceMark mark = node_instant(r.stamp.node, "measurements", r.stamp.true_time, measurement(r.id),
                                      {{"items", whole(r.truth_ids.size())}});
  ways_.measured(r.id, r.stamp.node, passed(mark));
}

void PerfettoExport::on(const records::CanFrameSent& r) {
  come_to(r.end.true_time);
  std::vector<TraceNote> notes{{"identifier", std::int64_t{r.identifier}},
                               {"fragment", std::int64_t{r.fragment}},
                               {"sender", names_.node(r.start.node)},
                               {"bytes", whole(r.data.size())}};
  if (r.sensor != kNoSensor) notes.push_back({"measurement", measurement({r.sensor, r.sequence})});
  const TraceMark mark = timeline_.slice(
      kCanGroup, names_.can_bus(r.bus), shown(r.start.true_time), shown(r.end.true_time),
      r.pdu == kNoPdu ? "frame" : fmt::format("{} {}", names_.pdu(r.pdu), r.sequence), std::move(notes));
  ways_.frame(false, r.bus, r.start.node, r.sensor, r.sequence, r.fragment, passed(mark));
}

// Marks an event of a controller in the lane of its CAN.
template <class Record> void PerfettoExport::can_instant(const Record& r, std::string name, TraceNote note) {
  timeline_.instant(kCanGroup, names_.can_bus(r.bus), come_to(r.stamp.true_time), std::move(name),
                    {{"node", names_.node(r.stamp.node)},
                     std::move(note),
                     {"transmit errors", std::int64_t{r.transmit_errors}},
                     {"receive errors", std::int64_t{r.receive_errors}}});
}

void PerfettoExport::on(const records::CanErrorFrame& r) {
  can_instant(r, to_text(CanTrouble(r.error)),
              {"detected as", std::string(r.as_transmitter ? "transmitter" : "receiver")});
}

void PerfettoExport::on(const records::CanStateChanged& r) {
  can_instant(r, fmt::format("{}: {}", names_.node(r.stamp.node), to_text(CanTrouble(r.to))),
              {"from", to_text(CanTrouble(r.from))});
}

void PerfettoExport::on(const records::SlotFrameSent& r) {
  const TrueTime start = come_to(r.stamp.true_time);
  const bool list = !r.null_frame && r.pdu != kNoPdu;
  std::vector<TraceNote> notes{{"slot", std::int64_t{r.slot}},
                               {"cycle", r.cycle},
                               {"sender", names_.node(r.stamp.node)},
                               {"bytes", whole(r.bytes.size())}};
  if (list) notes.push_back({"fragment", std::int64_t{r.fragment}});
  if (list && r.sensor != kNoSensor) notes.push_back({"measurement", measurement({r.sensor, r.sequence})});
  const TraceMark mark = timeline_.slice(kFlexRayGroup, channel_lane(r.channel), start, shown(r.end.true_time),
                                         list           ? fmt::format("{} {}", names_.pdu(r.pdu), r.sequence)
                                         : r.null_frame ? "null frame"
                                                        : "status",
                                         std::move(notes));
  if (list) ways_.frame(true, r.channel, r.stamp.node, r.sensor, r.sequence, r.fragment, passed(mark));
}

void PerfettoExport::on(const records::SymbolSent& r) {
  const TrueTime start = come_to(r.stamp.true_time);
  timeline_.slice(kFlexRayGroup, channel_lane(r.channel), start, shown(r.end.true_time), std::string(to_text(r.kind)),
                  {{"sender", names_.node(r.stamp.node)}});
}

void PerfettoExport::on(const records::ChannelFrame& r) {
  const std::string state = to_text(r.state);
  const std::string whose = r.slot != 0 ? fmt::format("slot {} of {}", r.slot, names_.node(r.sender))
                            : r.sender != kNoNode
                                ? fmt::format("the controller of {} did not send it", names_.node(r.sender))
                                : "no node sent it";
  timeline_.instant(kFlexRayGroup, channel_lane(r.channel), come_to(r.start), state.empty() ? "displaced frame" : state,
                    {{"whose", whose}, {"bytes", whole(r.bytes.size())}});
}

void PerfettoExport::on(const records::GuardianIntervention& r) {
  timeline_.instant(kFlexRayGroup, channel_lane(r.channel), come_to(r.at), r.cut ? "guardian cuts" : "guardian blocks",
                    {{"branch", r.branch == kNoNode ? "none" : names_.node(r.branch)}, {"why", std::string(r.why)}});
}

void PerfettoExport::on(const records::SlotProblem& r) {
  node_instant(r.stamp.node, "slot problems", r.stamp.true_time, to_text(r.status),
               {{"slot", std::int64_t{r.slot}}, {"cycle", r.cycle}, {"channel", channel_lane(r.channel)}});
}

void PerfettoExport::on(const records::ListHop& r) {
  using Deed = MeasurementWays::Deed;
  const MeasurementId id{r.sensor, r.sequence};
  if (const std::string_view loss = loss_text(r.hop); !loss.empty()) {
    const TraceMark mark = node_instant(r.stamp.node, "lost lists", r.stamp.true_time,
                                        fmt::format("{} {} {}", names_.pdu(r.pdu), r.sequence, loss), {});
    if (r.sensor != kNoSensor && r.hop != records::Hop::kStale)
      ways_.act({Deed::kLost, mark.at, r.stamp.node, {id}, 0, passed(mark)});
    return;
  }
  const bool passes = r.hop == records::Hop::kRead || r.hop == records::Hop::kWritten;
  if (!passes) return;
  if (r.sensor == kNoSensor)
    return r.hop == records::Hop::kRead ? ways_.read(r.stamp.node, r.pdu, r.sequence)
                                        : ways_.wrote(r.stamp.node, r.pdu);
  ways_.act(
      {r.hop == records::Hop::kRead ? Deed::kRead : Deed::kWritten, come_to(r.stamp.true_time), r.stamp.node, {id}, 0});
}

void PerfettoExport::on(const records::TaskRun& r) {
  const TrueTime start = come_to(r.start.true_time), end = shown(r.end.true_time);
  const std::string task = names_.task(r.start.node, r.task), node = names_.node(r.start.node);
  std::vector<TraceNote> notes;
  if (const TrueTime activated = shown(r.activated.true_time); activated < start)
    notes.push_back({"waited", microseconds(start - activated)});
  const TraceMark mark = timeline_.slice(node, task, start, end, task, std::move(notes));
  if (!r.deadline_met) timeline_.instant(node, task, std::max(start, end), "deadline missed", {});
  ways_.executed(r.start.node, start, end, passed(mark));
}

void PerfettoExport::on(const records::ClockCorrected& r) {
  const TrueTime at = come_to(r.stamp.true_time);
  const std::string node = names_.node(r.stamp.node);
  timeline_.counter(node, "offset correction [microticks]", at, r.offset_microticks);
  timeline_.counter(node, "rate correction [microticks]", at, r.rate_microticks);
  const std::pair<bool, const char*> flaws[] = {{r.offset_missing, "offset correction: no value"},
                                                {r.rate_missing, "rate correction: no value"},
                                                {r.offset_limited, "offset correction at its limit"},
                                                {r.rate_limited, "rate correction at its limit"}};
  for (const auto& [there, words] : flaws)
    if (there) node_instant(r.stamp.node, "clock synchronisation", r.stamp.true_time, words, {{"cycle", r.cycle}});
}

void PerfettoExport::on(const records::PrecisionSample& r) {
  timeline_.counter(kFlexRayGroup, "precision [us]", come_to(r.at), static_cast<double>(r.precision.ns) * 1e-3);
}

void PerfettoExport::on(const records::ListFused& r) {
  const TrueTime at = come_to(r.stamp.true_time);
  using Deed = MeasurementWays::Deed;
  const char* lost = nullptr;
  switch (r.disposition) {
    case records::Disposition::kFused:
    case records::Disposition::kFusedLate: ways_.act({Deed::kFused, at, r.stamp.node, {r.id}, 0}); break;
    case records::Disposition::kHeld: ways_.act({Deed::kHeld, at, r.stamp.node, {r.id}, 0}); break;
    case records::Disposition::kDroppedTooOld: lost = "too old"; break;
    case records::Disposition::kDuplicate: lost = "duplicate"; break;
  }
  if (lost == nullptr) return;
  const TraceMark mark =
      node_instant(r.stamp.node, "lost lists", r.stamp.true_time, fmt::format("{}: {}", measurement(r.id), lost), {});
  ways_.act({Deed::kRefused, at, r.stamp.node, {r.id}, 0, passed(mark)});
}

void PerfettoExport::on(const records::FusionStep& r) {
  timeline_.counter(names_.node(r.stamp.node), "confirmed tracks", come_to(r.stamp.true_time), r.confirmed);
}

void PerfettoExport::on(const records::ImageWritten& r) {
  ways_.act({MeasurementWays::Deed::kImage,
             come_to(r.stamp.true_time),
             r.stamp.node,
             {r.newest.begin(), r.newest.end()},
             r.sequence});
  if (r.newest.empty() || !within_reach(r.stamp.global.ns) || !within_reach(r.newest_measurement.ns) ||
      !within_reach(r.stamp.true_time.ns))
    return;
  images_.push_back({r.sequence, records::true_time_of(r.stamp, r.newest_measurement)});
  while (images_.size() > kImagesKept) images_.pop_front();
}

void PerfettoExport::on(const records::FeatureUsed& r) {
  const TrueTime at = come_to(r.stamp.true_time);
  if (r.stale) {
    node_instant(r.stamp.node, "refused images", r.stamp.true_time, fmt::format("image {} too old", r.image_sequence),
                 {});
    return;
  }
  ways_.act({MeasurementWays::Deed::kUsed, at, r.stamp.node, {}, r.image_sequence});
  const auto image = std::find_if(images_.rbegin(), images_.rend(),
                                  [&](const Image& one) { return one.sequence == r.image_sequence; });
  if (image != images_.rend())
    timeline_.counter(names_.node(r.stamp.node), "age of the newest measurement when used [ms]", at,
                      static_cast<double>((at - image->newest).ns) * 1e-6);
}

void PerfettoExport::on(const records::StateChanged& r) {
  std::vector<TraceNote> notes{{"from", std::string(r.from_name)}, {"why", std::string(r.why)}};
  if (!r.consequence.empty()) {
    TraceNote& note = notes.emplace_back();
    note.name = "consequence";
    note.value.emplace<std::string>(r.consequence);
  }
  node_instant(r.stamp.node, "controller", r.stamp.true_time, std::string(r.to_name), std::move(notes));
}

void PerfettoExport::on(const records::PowerChanged& r) {
  node_instant(r.stamp.node, "controller", r.stamp.true_time, r.on ? "power on" : "power off", {});
}

void PerfettoExport::on(const records::FaultActivity& r) {
  come_to(r.at);
  const std::string lane = fmt::format("fault {}: {}", r.fault, r.kind), text(r.text);
  switch (r.what) {
    case records::FaultAct::kBegins: timeline_.begin(kFaultGroup, lane, shown(r.at), text, {}); break;
    case records::FaultAct::kEnds: timeline_.end(kFaultGroup, lane, shown(r.at)); break;
    case records::FaultAct::kActs: timeline_.instant(kFaultGroup, lane, shown(r.at), text, {}); break;
  }
}

void PerfettoExport::on(const records::TimingProblem& r) {
  std::vector<TraceNote> notes{{"late", microseconds(r.late)}};
  if (r.slot != 0) {
    notes.push_back({"slot", std::int64_t{r.slot}});
    notes.push_back({"cycle", r.cycle});
    notes.push_back({"channel", channel_lane(r.channel)});
  }
  if (r.count > 1) notes.push_back({"times", std::int64_t{r.count}});
  node_instant(r.stamp.node, "timing problems", r.stamp.true_time, std::string(to_text(r.what)), std::move(notes));
}

}  // namespace ttf::recording::exports
