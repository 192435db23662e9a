// The central guardian: what the star coupler of one channel lets through. A pure judgement of a signal that begins at
// the coupler on the branch of a node, on the guardian's own clock; its memory is bus/guardian/startup_turns.h's, its
// place sim/medium/star_coupler.h.
//
// A coupler receives everything and sends it on afresh. So it may look at what it forwards: a frame's header is known
// before the first bit leaves (what that delay means: sim/medium/coupler.h). Frame CRCs come too late for it: a wrong
// one is wrong for all.
//
// On a schedule (its controller's clock runs, integrated like any node's; bus/controller/controller.h):
//   G1  in a static slot only the frame passes that the cluster's schedule has there in this cycle on this channel: its
//       node, id, cycle count, length, sync and startup indicators
//   G2  and only if it begins within half an action point offset of the slot's action point. While the cluster's clocks
//       are within that of one another, no fault-free node's frame is refused, and one that passes lies within its slot
//       for every receiver: there is nothing slightly off that some accept and some do not
//   G3  in the dynamic segment the guardian counts slots as every node does, and lets through the frame of that slot's
//       node, not later than its pLatestTx and not longer than its PDU, and only if it begins within half a minislot
//       action point offset of the minislot's action point: no receiver counts another minislot then (and G9)
//   G4  in the symbol window a media access test symbol, of any node
//   G5  else nothing; and nothing that it cannot make out
// Without a schedule (the rules of turns are bus/guardian/startup_turns.h's S1 to S6):
//   G6  of coldstart nodes the collision avoidance symbol and startup frames, of any node a wake-up pattern on its
//       channel
// Always:
//   G7  one signal at a time: the first to come; and none for longer than one of its kind may last
//   G8  while the guardian is integrating, in cycles 0 to 3 only the node that it integrates on: another's frame would
//       make a leading coldstart node give way
// How it ends what it lets through in the dynamic segment:
//   G9  at a minislot action point of its own clock, whatever its sender does: there receivers look for the end of a
//       trailing sequence, and between two of them some would count another minislot than others, and every slot behind
//       it differently. What ends within half a minislot action point offset of one, as every fault-free node's frame
//       does, is left alone, to the instant. What ends elsewhere, because its sender fell silent or its clock is off,
//       the coupler holds active to the next one, as a trailing sequence would be; what lasts too long (G7) it cuts at
//       the last one that a frame of that length may need. A frame whose trailing sequence alone was lengthened is what
//       it was, one that broke off or was cut is undecodable
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "bus/controller/dynamic_segment.h"
#include "bus/controller/slot_table.h"
#include "bus/ports/flexray_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus::guardian {

enum class GuardianReason : std::uint8_t {
  kForwarded,
  kOtherForwarded,   // G7
  kUndecodable,      // G5
  kNobodysTime,      // G5: between the segments, in the idle time
  kNotItsSlot,       // G1, G3
  kOutsideWindow,    // G2, G3
  kWrongHeader,      // G1, G3
  kNoSymbolNow,      // G4, G5
  kNoColdstartNode,  // G6
  kNoStartupFrame,   // G6
  kOtherLeads,       // S1, G8
  kTooSoon,          // S2
  kLeadFailed,       // S3
  kNoWakeup,         // S5
};
inline constexpr std::array kAllGuardianReasons = {
    GuardianReason::kForwarded,      GuardianReason::kOtherForwarded, GuardianReason::kUndecodable,
    GuardianReason::kNobodysTime,    GuardianReason::kNotItsSlot,     GuardianReason::kOutsideWindow,
    GuardianReason::kWrongHeader,    GuardianReason::kNoSymbolNow,    GuardianReason::kNoColdstartNode,
    GuardianReason::kNoStartupFrame, GuardianReason::kOtherLeads,     GuardianReason::kTooSoon,
    GuardianReason::kLeadFailed,     GuardianReason::kNoWakeup};
std::string_view to_text(GuardianReason reason);

// What begins at the coupler; instants in microticks of the guardian.
struct GuardianSignal {
  NodeId branch{};
  ports::Signal signal{};
  Microticks start{};
  const wire::DecodedFrame* frame = nullptr;  // of a frame
};

struct GuardianAnswer {
  GuardianReason reason{};
  Microticks until{};  // forwarded: what lasts longer is cut there; in the dynamic segment an action point (G9)
  static constexpr GuardianAnswer no(GuardianReason reason) { return {reason, {}}; }
  bool forwards() const { return reason == GuardianReason::kForwarded; }
};

// Two clocks at cClockDeviationMax, one fast, one slow.
inline constexpr std::int64_t kDriftOfAPair_ppm = 3000;

// How long a signal of each kind may last in the guardian's microticks, a node's clock being off by what it may.
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

// The part of the judgement that goes by the schedule: G1 to G5, and G9. Without memory.
class Guardian {
 public:
  // `clock`: the parameters of the guardian's own controller (guardian_cluster() below).
  Guardian(const schedules::model::Cluster& cluster, schedules::model::Channel channel,
           const schedules::model::NodeParameters& clock);

  // `counter`: how far the dynamic slots of this cycle are on this channel.
  GuardianAnswer judge(const timebase::CycleClock& clock, const controller::DynamicSlotCounter& counter,
                       const GuardianSignal& signal) const;
  // When a signal ends at the coupler that has been forwarded since `start`, was to last until `until` at the most (of
  // its answer) and is ended by its sender at `end`: `end` where nothing is done about it. G7, and in the dynamic
  // segment G9; all three instants are the coupler's.
  Microticks end_of(const timebase::CycleClock& clock, Microticks start, Microticks end, Microticks until) const;
  // Counts what was received in the dynamic segment, in whole or in part (bus/controller/dynamic_segment.h).
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

// The cluster as the guardian's controller sees it: with one node more, the last, which is the guardian on that
// channel. It sends nothing; its parameters are those of the first node on the channel, its branch has no length.
schedules::model::Cluster guardian_cluster(const schedules::model::Cluster& cluster, schedules::model::Channel channel);

}  // namespace ttf::bus::guardian
