#include "report/timing/diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "report/drawing/axes.h"
#include "report/drawing/log_limits.h"
#include "report/timing/painter.h"

namespace ttf::report {
namespace {

constexpr Duration kMargin = Duration::milliseconds(300);  // ways of at most this length are followed into the window

}  // namespace

TimingDiagram::TimingDiagram(Names names, Duration cycle, TrueTime from, TrueTime to)
    : names_(std::move(names)), cycle_(cycle <= kLongestCycle ? cycle : Duration{}), from_(from), to_(to) {}

bool TimingDiagram::near(TrueTime start, TrueTime end) const {
  return possible(start.ns) && possible(end.ns) && start <= to_ + kMargin && end >= from_ - kMargin;
}

void TimingDiagram::on(const records::Measured& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.measurements.push_back({r.stamp.true_time, r.id});
}
void TimingDiagram::on(const records::CanFrameSent& r) {
  if (near(r.start.true_time, r.end.true_time))
    data_.can_frames.push_back({r.bus, r.start.true_time, r.end.true_time, r.pdu, r.sequence});
}
void TimingDiagram::on(const records::SlotFrameSent& r) {
  const bool in_a_run = possible(r.stamp.global.ns) && possible_cycle(r.cycle);
  if (in_a_run && near(r.stamp.true_time, r.end.true_time))
    data_.slot_frames.push_back({r.stamp.true_time, r.end.true_time, r.stamp.global, r.stamp.node, r.cycle, r.slot,
                                 r.channel, r.null_frame, r.pdu, r.sequence, r.fragment,
                                 r.stamp.global.ns != r.stamp.local.ns});
}
void TimingDiagram::on(const records::ListHop& r) {
  if (near(r.stamp.true_time, r.stamp.true_time))
    data_.hops.push_back({r.stamp.true_time, r.stamp.node, r.hop, r.pdu, r.sequence});
}
void TimingDiagram::on(const records::TaskRun& r) {
  if (possible(r.start.true_time.ns) && near(r.activated.true_time, r.end.true_time))
    data_.runs.push_back(
        {r.activated.true_time, r.start.true_time, r.end.true_time, r.start.node, r.task, r.deadline_met});
}
void TimingDiagram::on(const records::ListFused& r) {
  if (possible(r.measured.ns) && near(r.stamp.true_time, r.stamp.true_time))
    data_.fused.push_back({r.stamp.true_time, r.stamp.node, r.step, r.id, r.measured, r.disposition});
}
void TimingDiagram::on(const records::FusionStep& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.steps.push_back({r.stamp.true_time, r.stamp.node, r.step});
}
void TimingDiagram::on(const records::ImageWritten& r) {
  if (near(r.stamp.true_time, r.stamp.true_time))
    data_.images.push_back({r.stamp.true_time, r.stamp.node, r.sequence, {r.newest.begin(), r.newest.end()}});
}
void TimingDiagram::on(const records::FeatureUsed& r) {
  if (near(r.stamp.true_time, r.stamp.true_time))
    data_.uses.push_back({r.stamp.true_time, r.stamp.node, r.image_sequence, r.fresh, r.stale});
}

void TimingDiagram::on(const records::FaultActivity& r) {
  // What began long ago may still last.
  if (possible(r.at) && r.at <= to_ && (r.what != records::kFaultActs || r.at >= from_))
    data_.faults.push_back({r.at, r.fault, r.what, r.node, std::string(r.kind), std::string(r.text)});
}
void TimingDiagram::on(const records::ChannelFrame& r) {
  if (near(r.start, r.end) && possible(r.sent))
    data_.on_channel.push_back({r.start, r.end, r.sender, r.channel, r.state, r.slot, r.sent, r.sent_channel});
}

void TimingDiagram::on(const records::TimingProblem& r) {
  if (near(r.stamp.true_time, r.stamp.true_time))
    data_.problems.push_back({r.stamp.true_time, r.stamp.node, r.what, r.late, r.cycle, r.slot, r.channel, r.count});
}

std::string TimingDiagram::svg(TimingUse use) const {
  // These make the lanes; what was fused or used is drawn between them.
  const bool nothing =
      data_.measurements.empty() && data_.can_frames.empty() && data_.slot_frames.empty() && data_.runs.empty();
  if (from_ >= to_ || nothing)
    return empty_picture("Timing diagram", fmt::format("There are no records between {} ms and {} ms.",
                                                       number(in_ms(from_)), number(in_ms(to_))));
  // Told of when it ended or, in a merged log, where it began: the picture is the same.
  TimingData data = data_;
  std::ranges::stable_sort(data.runs, {}, [](const TimingData::Run& run) { return std::tuple(run.start, run.node); });
  return paint_timing(names_, data, cycle_, from_, to_, use);
}

}  // namespace ttf::report
