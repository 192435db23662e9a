#include "report/timing/diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "report/drawing/axes.h"
#include "report/drawing/log_limits.h"
#include "report/timing/painter.h"

namespace ttf::report::timing {

TimingDiagram::TimingDiagram(drawing::Names names, Duration cycle, TrueTime from, TrueTime to)
    : names_(std::move(names)), cycle_(cycle <= drawing::kLongestCycle ? cycle : Duration{}), from_(from), to_(to) {}

bool TimingDiagram::near(TrueTime start, TrueTime end) const {
  return drawing::possible(start.ns) && drawing::possible(end.ns) && start <= to_ + kMargin && end >= from_ - kMargin;
}

void TimingDiagram::on(const recording::records::Measured& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.measurements.push_back({r.stamp.true_time, r.id});
}
void TimingDiagram::on(const recording::records::CanFrameSent& r) {
  if (near(r.start.true_time, r.end.true_time))
    data_.can_frames.push_back(
        {r.bus, r.start.true_time, r.end.true_time, r.pdu, r.sequence, r.fragment, r.start.node, r.sensor});
}
void TimingDiagram::on(const recording::records::SlotFrameSent& r) {
  const bool in_a_drive = drawing::possible(r.stamp.global.ns) && drawing::possible_cycle(r.cycle);
  if (in_a_drive && near(r.stamp.true_time, r.end.true_time))
    data_.slot_frames.push_back({r.stamp.true_time, r.end.true_time, r.stamp.global, r.stamp.node, r.cycle, r.slot,
                                 r.channel, r.null_frame, r.pdu, r.sequence, r.fragment, r.sensor,
                                 r.stamp.global.ns != r.stamp.local.ns});
}
void TimingDiagram::on(const recording::records::ListHop& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.hops.push_back(r);
}
void TimingDiagram::on(const recording::records::TaskRun& r) {
  if (drawing::possible(r.start.true_time.ns) && near(r.activated.true_time, r.end.true_time))
    data_.executions.push_back(r);
}
void TimingDiagram::on(const recording::records::ListFused& r) {
  if (drawing::possible(r.measured.ns) && near(r.stamp.true_time, r.stamp.true_time)) data_.fused.push_back(r);
}
void TimingDiagram::on(const recording::records::FusionStep& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.steps.push_back(r);
}
void TimingDiagram::on(const recording::records::ImageWritten& r) {
  if (near(r.stamp.true_time, r.stamp.true_time))
    data_.images.push_back({r.stamp, r.sequence, {r.newest.begin(), r.newest.end()}});
}
void TimingDiagram::on(const recording::records::FeatureUsed& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.uses.push_back({r.stamp, r.image_sequence, r.stale});
}

void TimingDiagram::on(const recording::records::FaultActivity& r) {
  // An old fault may still last.
  if (drawing::possible(r.at) && r.at <= to_ && (r.what != recording::records::FaultAct::kActs || r.at >= from_))
    data_.faults.push_back(r);
}
void TimingDiagram::on(const recording::records::ChannelFrame& r) {
  if (near(r.start, r.end) && drawing::possible(r.sent))
    data_.on_channel.push_back({r.start, r.end, r.sender, r.channel, r.state, r.slot, r.sent, r.sent_channel});
}

void TimingDiagram::on(const recording::records::TimingProblem& r) {
  if (near(r.stamp.true_time, r.stamp.true_time)) data_.problems.push_back(r);
}

bool TimingDiagram::shows_anything() const {
  const auto within = [&](TrueTime start, TrueTime end) { return start < to_ && end >= from_; };
  const auto any = [&](const auto& all) {
    return std::ranges::any_of(all, [&](const auto& one) { return within(one.start, one.end); });
  };
  return std::ranges::any_of(data_.measurements, [&](const auto& one) { return within(one.at, one.at); }) ||
         any(data_.can_frames) || any(data_.slot_frames) || std::ranges::any_of(data_.executions, [&](const auto& one) {
           return within(one.activated.true_time, one.end.true_time);
         });
}

std::string TimingDiagram::svg(TimingUse use, const drawing::Sheet& sheet) const {
  // These records make the lanes; fusion and use are drawn between them.
  const bool nothing =
      data_.measurements.empty() && data_.can_frames.empty() && data_.slot_frames.empty() && data_.executions.empty();
  if (from_ >= to_ || nothing)
    return drawing::empty_picture("Timing diagram",
                                  fmt::format("There are no records between {} ms and {} ms.",
                                              drawing::number(in_ms(from_)), drawing::number(in_ms(to_))),
                                  sheet);
  // A log records an execution at its end, a merged log at its start: sorting gives the same picture.
  TimingData data = data_;
  std::ranges::stable_sort(data.executions, {}, [](const recording::records::TaskRun& one) {
    return std::tuple(one.start.true_time, one.start.node);
  });
  return paint_timing(names_, data, cycle_, from_, to_, use, sheet);
}

}  // namespace ttf::report::timing
