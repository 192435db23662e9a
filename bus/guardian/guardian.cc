#include "bus/guardian/guardian.h"

#include <algorithm>
#include <cstdlib>

#include "core/check.h"

namespace ttf::bus::guardian {

using schedules::model::Channel;
using schedules::model::FrameSlot;

SignalLengths::SignalLengths(const schedules::model::GlobalParameters& flexray, std::int64_t microtick_ps)
    : flexray_(flexray), microtick_ps_(microtick_ps) {}

Microticks SignalLengths::bits(std::int64_t count) const {
  const std::int64_t ps = (count + 1) * flexray_.gdBit_ps;
  return time(ps + ps * kDriftOfAPair_ppm / 1'000'000);
}

schedules::model::Cluster guardian_cluster(const schedules::model::Cluster& cluster, Channel channel) {
  schedules::model::Cluster with = cluster;
  const auto model = std::find_if(cluster.nodes.begin(), cluster.nodes.end(), [&](const schedules::model::Node& node) {
    return node.flexray && includes(node.flexray->pChannels, channel);
  });
  TTF_CHECK(model != cluster.nodes.end(), "no node is on channel {}", channel == Channel::kA ? "A" : "B");
  schedules::model::Node guardian;
  guardian.name = channel == Channel::kA ? "guardian A" : "guardian B";
  guardian.flexray = *model->flexray;
  schedules::model::NodeParameters& p = *guardian.flexray;
  guardian.microtick_ps = p.pdMicrotick_ps;
  p.pChannels = channel == Channel::kA ? schedules::model::Channels::kA : schedules::model::Channels::kB;
  p.pKeySlotId = 0;
  p.pKeySlotUsedForStartup = p.pKeySlotUsedForSync = p.pKeySlotOnlyEnabled = false;
  // Two nodes are two branches apart; the guardian is one branch from each.
  p.pDelayCompensationA /= 2;
  p.pDelayCompensationB /= 2;
  p.pAllowHaltDueToClock = true;
  with.nodes.push_back(std::move(guardian));
  return with;
}

Guardian::Guardian(const schedules::model::Cluster& cluster, Channel channel,
                   const schedules::model::NodeParameters& clock)
    : cluster_(cluster), g_(cluster.flexray), channel_(channel), slots_(cluster, kNoNode), minislots_(cluster.flexray),
      lengths_(cluster.flexray, clock.pdMicrotick_ps), compensation_{channel == Channel::kA
                                                                         ? clock.pDelayCompensationA
                                                                         : clock.pDelayCompensationB},
      tolerance_(lengths_.time(g_.gdActionPointOffset * g_.gdMacrotick_ps / 2)),
      minislot_tolerance_(std::min(tolerance_, lengths_.time(g_.gdMinislotActionPointOffset * g_.gdMacrotick_ps / 2))) {
}

int Guardian::cycle_count(const timebase::CycleClock& clock) const {
  return static_cast<int>(clock.cycle() % (g_.gCycleCountMax + 1));
}

GuardianAnswer Guardian::judge(const timebase::CycleClock& clock, const controller::DynamicSlotCounter& counter,
                               const GuardianSignal& signal) const {
  const Microticks at = signal.start - compensation_;
  const std::int64_t static_end = static_cast<std::int64_t>(g_.gNumberOfStaticSlots) * g_.gdStaticSlot;
  if (signal.signal == ports::Signal::kUndecodable ||
      (signal.signal == ports::Signal::kFrame && !wire::has_header(*signal.frame)))
    return GuardianAnswer::no(GuardianReason::kUndecodable);
  if (signal.signal != ports::Signal::kFrame) {
    const Macroticks window =
        minislots_.count() > 0 ? minislots_.start_of(minislots_.count() + 1) : Macroticks{static_end};
    const bool due = signal.signal == ports::Signal::kCas && g_.gdSymbolWindow > 0 && at >= clock.start_of(window);
    const Microticks window_end = due ? clock.start_of(window + Macroticks{g_.gdSymbolWindow}) : Microticks{};
    if (!due || at >= window_end) return GuardianAnswer::no(GuardianReason::kNoSymbolNow);
    return {GuardianReason::kForwarded, std::min(signal.start + lengths_.symbol(), window_end + compensation_)};
  }
  if (at < clock.cycle_start()) return GuardianAnswer::no(GuardianReason::kNobodysTime);
  if (at < clock.start_of(Macroticks{static_end})) return in_static_slot(clock, at, signal);
  const int minislot = minislots_.minislot_at(clock, at);
  if (minislot < 1 || minislot > minislots_.count()) return GuardianAnswer::no(GuardianReason::kNobodysTime);
  return in_dynamic_segment(clock, counter, at, signal);
}

// Finds the slot that contains `at`, and requires its action point to be near.
GuardianAnswer Guardian::in_static_slot(const timebase::CycleClock& clock, Microticks at,
                                        const GuardianSignal& signal) const {
  int low = 1, high = g_.gNumberOfStaticSlots;
  const auto slot_start = [&](int slot) {
    return clock.start_of(Macroticks{static_cast<std::int64_t>(slot - 1) * g_.gdStaticSlot});
  };
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (slot_start(middle) <= at)
      low = middle;
    else
      high = middle - 1;
  }
  const FrameSlot* frame = slots_.expected(low, cycle_count(clock), channel_);
  if (frame == nullptr || frame->sender != signal.branch) return GuardianAnswer::no(GuardianReason::kNotItsSlot);
  const Microticks action_point =
      clock.start_of(Macroticks{static_cast<std::int64_t>(low - 1) * g_.gdStaticSlot + g_.gdActionPointOffset});
  if (std::abs((at - action_point).value) > tolerance_.value) return GuardianAnswer::no(GuardianReason::kOutsideWindow);
  if (!header_fits(*frame, cycle_count(clock), signal.frame->header))
    return GuardianAnswer::no(GuardianReason::kWrongHeader);
  return {GuardianReason::kForwarded, signal.start + lengths_.frame(g_.gPayloadLengthStatic)};
}

GuardianAnswer Guardian::in_dynamic_segment(const timebase::CycleClock& clock,
                                            const controller::DynamicSlotCounter& counter, Microticks at,
                                            const GuardianSignal& signal) const {
  const int minislot = minislots_.minislot_at(clock, at);
  const FrameSlot* frame = slots_.expected(counter.slot_in(minislot), cycle_count(clock), channel_);
  if (frame == nullptr || frame->sender != signal.branch) return GuardianAnswer::no(GuardianReason::kNotItsSlot);
  if (minislot > cluster_.node(signal.branch).flexray->pLatestTx)
    return GuardianAnswer::no(GuardianReason::kOutsideWindow);
  // Near a minislot's boundary receivers would count different minislots, and so different slots afterwards.
  if (std::abs((at - clock.start_of(minislots_.action_point(minislot))).value) > minislot_tolerance_.value)
    return GuardianAnswer::no(GuardianReason::kOutsideWindow);
  if (!header_fits(*frame, cycle_count(clock), signal.frame->header))
    return GuardianAnswer::no(GuardianReason::kWrongHeader);
  // The trailing sequence ends at the next minislot action point that leaves room for one bit of it. On the
  // sender's clock that may be one later than here.
  const Microticks frame_end = at + lengths_.frame(signal.frame->header.payload_words);
  const int last = std::min(minislots_.dts_end(clock, frame_end, Microticks{}) + 1, minislots_.count());
  return {GuardianReason::kForwarded, clock.start_of(minislots_.action_point(last)) + compensation_};
}

Microticks Guardian::end_of(const timebase::CycleClock& clock, Microticks start, Microticks end,
                            Microticks until) const {
  const int first = minislots_.minislot_at(clock, start - compensation_);
  if (first < 1 || first > minislots_.count()) return std::min(end, until);
  // The first action point that `end` is not clearly behind.
  const int minislot = minislots_.dts_end(clock, end - compensation_, Microticks{-minislot_tolerance_.value});
  if (minislot > minislots_.count()) return until;
  const Microticks action_point = clock.start_of(minislots_.action_point(minislot)) + compensation_;
  if (action_point > until) return until;
  return action_point - end <= minislot_tolerance_ ? end : action_point;
}

bool Guardian::header_fits(const FrameSlot& frame, int counter, const wire::FrameHeader& header) const {
  if (header.frame_id != frame.slot || header.cycle != counter) return false;
  if (frame.slot > g_.gNumberOfStaticSlots) {
    if (header.sync || header.startup || frame.pdu == kNoPdu) return false;
    // A message id may precede the fragment.
    return header.payload_words <= (cluster_.pdu(frame.pdu).fragment_bytes + 1) / 2 + 1;
  }
  const schedules::model::NodeParameters& p = *cluster_.node(frame.sender).flexray;
  const bool key_slot = frame.slot == p.pKeySlotId;
  return header.payload_words == g_.gPayloadLengthStatic && header.sync == (key_slot && p.pKeySlotUsedForSync) &&
         header.startup == (key_slot && p.pKeySlotUsedForStartup);
}

void Guardian::count(const timebase::CycleClock& clock, controller::DynamicSlotCounter& counter, Microticks start,
                     Microticks end) const {
  const int first = minislots_.minislot_at(clock, start);
  const int last = std::max(first, minislots_.minislot_at(clock, end - compensation_));
  if (last < 1 || first > minislots_.count()) return;
  counter.occupied(std::max(first, 1), last);
}

}  // namespace ttf::bus::guardian
