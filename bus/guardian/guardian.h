// The central guardian decides which signals the star coupler of one channel forwards. It judges a signal that
// begins at the coupler on a node's branch, by the guardian's own clock. Its memory is in
// bus/guardian/startup_turns.h, its place in sim/medium/star_coupler.h.
//
// A coupler receives every signal and sends it on afresh, so it can inspect what it forwards. It has a
// frame's header before the first bit leaves (sim/medium/coupler.h says what that delay means). It cannot wait
// for the frame CRC; a wrong one is wrong for all receivers.
//
// With a schedule (its controller's clock runs, integrated like any node's; bus/controller/controller.h):
//   G1  in a static slot only the cluster's scheduled frame of this cycle and channel passes: its node, id, cycle
//       count, length, sync and startup indicators
//   G2  it must begin within half an action point offset of the slot's action point. While the cluster's clocks differ
//       by no more than that, every frame of a fault-free node passes, and every frame that passes lies within its slot
//       for all receivers: no frame is slightly off, so that only some receivers accept it
//   G3  in the dynamic segment the guardian counts slots as every node does. The frame of the slot's node passes, no
//       later than its pLatestTx and no longer than its PDU. It must begin within half a minislot action point offset
//       of the minislot's action point, so that all receivers count the same minislot (and G9)
//   G4  in the symbol window a media access test symbol of any node passes
//   G5  all other signals are refused, and all that the guardian cannot decode
// Without a schedule (bus/guardian/startup_turns.h has the rules of start-up turns, S1 to S6):
//   G6  the collision avoidance symbol and startup frames of coldstart nodes pass, and a wake-up pattern of any node on
//       its channel
// Always:
//   G7  one signal at a time passes, the first to come; none for longer than one of its kind may last
//   G8  while the guardian integrates, only the node that it integrates on passes in cycles 0 to 3: another node's
//       frame would make a leading coldstart node give way
// The end of forwarded signals in the dynamic segment:
//   G9  a signal ends at a minislot action point of the guardian's clock, whatever its sender does. There receivers
//       look for the end of a trailing sequence; between two of them some would count another minislot than others,
//       and so every later slot. An end within half a minislot action point offset of one stays as it is, as that of
//       every fault-free node's frame. After any other end, because the sender fell silent or its clock is off, the
//       coupler keeps the channel active to the next one, like a trailing sequence. It cuts a signal that lasts too
//       long (G7) at the last one that a frame of that length may need. A frame with only a longer trailing sequence
//       stays valid; a frame that broke off or was cut is undecodable
#pragma once

#include <cstdint>
#include <vector>

#include "bus/controller/dynamic_segment.h"
#include "bus/controller/slot_table.h"
#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/enumerations.h"
#include "schedules/model/cluster.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus::guardian {

using recording::records::GuardianReason;
using recording::records::kAllGuardianReasons;

// A signal that begins at the coupler; instants in microticks of the guardian.
struct GuardianSignal {
  NodeId branch{};
  ports::Signal signal{};
  Microticks start{};
  const wire::DecodedFrame* frame = nullptr;  // of a frame
};

struct GuardianAnswer {
  GuardianReason reason{};
  Microticks until{};  // if forwarded: longer signals are cut there; in the dynamic segment an action point (G9)
  static constexpr GuardianAnswer no(GuardianReason reason) { return {reason, {}}; }
  bool forwards() const { return reason == GuardianReason::kForwarded; }
};

// Two clocks at cClockDeviationMax, one fast, one slow.
inline constexpr std::int64_t kDriftOfAPair_ppm = 3000;

// The longest duration of each kind of signal in the guardian's microticks, with both clocks at their limits.
class SignalLengths {
 public:
  SignalLengths(const schedules::model::GlobalParameters& flexray, std::int64_t microtick_ps);
  Microticks frame(int payload_words) const { return bits(schedules::model::frame_bits(flexray_, payload_words)); }
  Microticks symbol() const { return bits(flexray_.gdCASRxLowMax); }
  Microticks wakeup_pattern(int repetitions) const {
    return bits(repetitions * (flexray_.gdWakeupSymbolTxLow + flexray_.gdWakeupSymbolTxIdle));
  }
  Microticks time(std::int64_t ps) const { return {(ps + microtick_ps_ - 1) / microtick_ps_}; }

 private:
  Microticks bits(std::int64_t count) const;
  const schedules::model::GlobalParameters& flexray_;
  std::int64_t microtick_ps_;
};

// The judgement by the schedule: G1 to G5, and G9. It has no memory.
class Guardian {
 public:
  // `clock`: the parameters of the guardian's own controller (guardian_cluster() below).
  Guardian(const schedules::model::Cluster& cluster, schedules::model::Channel channel,
           const schedules::model::NodeParameters& clock);

  // `counter`: the dynamic slot counter of this cycle and channel.
  GuardianAnswer judge(const timebase::CycleClock& clock, const controller::DynamicSlotCounter& counter,
                       const GuardianSignal& signal) const;
  // Returns the end at the coupler of a forwarded signal. It began at `start`, its sender ends it at `end`,
  // and its answer limits it to `until`. Returns `end` if the guardian does not intervene. Applies G7 and, in
  // the dynamic segment, G9; all instants are the coupler's.
  Microticks end_of(const timebase::CycleClock& clock, Microticks start, Microticks end, Microticks until) const;
  // Counts a reception that lies in the dynamic segment, wholly or partly (bus/controller/dynamic_segment.h).
  void count(const timebase::CycleClock& clock, controller::DynamicSlotCounter& counter, Microticks start,
             Microticks end) const;

 private:
  GuardianAnswer in_static_slot(const timebase::CycleClock& clock, Microticks at, const GuardianSignal& signal) const;
  GuardianAnswer in_dynamic_segment(const timebase::CycleClock& clock, const controller::DynamicSlotCounter& counter,
                                    Microticks at, const GuardianSignal& signal) const;
  bool header_fits(const schedules::model::FrameSlot& frame, int counter, const wire::FrameHeader& header) const;
  int cycle_count(const timebase::CycleClock& clock) const;

  const schedules::model::Cluster& cluster_;
  const schedules::model::GlobalParameters& g_;
  schedules::model::Channel channel_;
  controller::SlotTable slots_;
  controller::MinislotGrid minislots_;
  SignalLengths lengths_;
  Microticks compensation_, tolerance_, minislot_tolerance_;
};

// Returns the cluster as the guardian's controller sees it. It has one more node, the last: the guardian on that
// channel. This node sends nothing; it has the parameters of the channel's first node and a branch of no length.
schedules::model::Cluster guardian_cluster(const schedules::model::Cluster& cluster, schedules::model::Channel channel);

}  // namespace ttf::bus::guardian
