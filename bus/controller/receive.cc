// Frame and symbol processing: finds the slot of each reception and judges it there (FlexRay 2.1A, chapter 6).
#include <algorithm>
#include <array>
#include <cstdlib>

#include "bus/controller/state.h"
#include "core/check.h"

namespace ttf::bus::controller {
namespace {

using schedules::model::Channel;
using schedules::model::FrameSlot;

constexpr int kIdleDelimiterBits = 11;  // cChannelIdleDelimiter

bool receiver_on(poc::PocKind kind) {
  switch (kind) {
    case poc::PocKind::kDefaultConfig:
    case poc::PocKind::kConfig:
    case poc::PocKind::kReady:
    case poc::PocKind::kHalt: return false;
    case poc::PocKind::kNormalActive:
    case poc::PocKind::kNormalPassive:
    case poc::PocKind::kWakeupListen:
    case poc::PocKind::kWakeupSend:
    case poc::PocKind::kWakeupDetect:
    case poc::PocKind::kColdstartListen:
    case poc::PocKind::kColdstartCollisionResolution:
    case poc::PocKind::kColdstartConsistencyCheck:
    case poc::PocKind::kColdstartGap:
    case poc::PocKind::kColdstartJoin:
    case poc::PocKind::kIntegrationColdstartCheck:
    case poc::PocKind::kIntegrationListen:
    case poc::PocKind::kIntegrationConsistencyCheck:
    case poc::PocKind::kInitialiseSchedule: return true;
  }
  TTF_CHECK(false, "state {}", static_cast<int>(kind));
}

}  // namespace

inline void FlexRayController::State::judge(const ports::Reception& reception, bool conflict) {
  if (g.gdSymbolWindow > 0 && (segment == Segment::kDynamic || segment == Segment::kRest))
    judge_symbol_window(reception, conflict);
  SlotStatus errors = conflict ? kTransmissionConflict | kSyntaxError : kValidFrame;
  if (!is_frame(reception)) errors |= kSyntaxError;
  const int slot = static_slot_at(reception.start);
  if (slot >= 1 && slot <= g.gNumberOfStaticSlots) return judge_static(reception, slot, errors);
  judge_elsewhere(reception, slot, errors, conflict);
}

void FlexRayController::State::receive(const ports::Reception& reception) {
  if (!receiver_on(poc.kind)) return;
  const auto c = index_of(reception.channel);
  // A controller that is sending cannot decode other signals.
  const bool conflict = talks_over(reception, c);
  if (clock && !poc::in_startup(poc.kind)) return judge(reception, conflict);
  receive_in_startup(reception, conflict);
  due = next_event();
}

bool FlexRayController::State::receive_on_both(const ports::Reception& reception) {
  const Microticks due_before = due;
  const poc::PocKind kind_before = poc.kind;
  if (!judge_on_both(reception)) {
    receive(reception);
    receive(on_b(reception));
  }
  return due != due_before || poc.kind != kind_before;
}

// Returns the scheduled frame if this one is valid in its slot on both channels and the slot was silent so
// far. Returns null otherwise.
const FrameSlot* FlexRayController::State::first_of_slot_on_both(const ports::Reception& reception) const {
  const int slot = reception.frame.header.frame_id;
  if (slot < 1 || slot > g.gNumberOfStaticSlots || !is_frame(reception) ||
      !is_of_slot(reception.frame.header, slot, counter) || !board.nothing(slot))
    return nullptr;
  const Microticks cycle_start = clock->cycle_start();
  if (reception.start < cycle_start + line(slot).from || reception.end > cycle_start + line(slot + 1).from)
    return nullptr;
  return slots.expected_on_both(slot, counter);
}

// Judges both channels at once. Returns false, without effect, if they must be judged one by one.
bool FlexRayController::State::judge_on_both(const ports::Reception& reception) {
  if (!in_operation() || talks_over(reception, 0) || talks_over(reception, 1) ||
      (g.gdSymbolWindow > 0 && segment != Segment::kStatic))
    return false;
  const FrameSlot* const expected = first_of_slot_on_both(reception);
  if (expected == nullptr) return false;
  const int slot = expected->slot;
  const bool under_way = board.under_way();
  board.receive_a(slot);
  accept(reception, Channel::kA, slot, expected);
  // The host may act on that event.
  if (!in_operation() || board.under_way() != under_way) {
    receive(on_b(reception));
    return true;
  }
  board.receive_b(slot);
  accept(reception, Channel::kB, slot, expected);
  return true;
}

bool FlexRayController::State::is_known(const ports::Reception& reception) {
  // Until the reception ends the controller neither sends nor reads slot status, and its own transmissions are over.
  if (due <= reception.end || segment != Segment::kStatic || wants_receptions || !in_operation() ||
      reception.start < std::max(sending_to[0], sending_to[1]) || reception.frame.header.payload_preamble)
    return false;
  const FrameSlot* const expected = first_of_slot_on_both(reception);
  if (expected == nullptr) return false;
  if (reception.frame.header.null_frame || expected->pdu == kNoPdu) return true;
  const auto bytes = static_cast<std::size_t>(cluster.pdu(expected->pdu).fragment_bytes);
  return cni.incoming(expected->pdu).is_known(reception.frame.payload.first(bytes), expected->fragment);
}

void FlexRayController::State::receive_known(const ports::Reception& reception) {
  const wire::FrameHeader& header = reception.frame.header;
  board.receive_a(header.frame_id);
  board.receive_b(header.frame_id);
  if (header.sync) receive_sync(reception, header.frame_id, schedules::model::Channels::kAB);
}

void FlexRayController::State::receive_in_startup(const ports::Reception& reception, bool conflict) {
  apply({poc::PocEventKind::kChannelActive}, reception.end);
  if (conflict && wakeup_sent != kNever<Microticks>) {
    apply({poc::PocEventKind::kWakeupCollision}, reception.end);
  } else if (!conflict) {
    if (is_cas(reception)) apply({poc::PocEventKind::kCasReceived}, reception.end);
    if (reception.signal == ports::Signal::kWakeup && pattern_wakes && reception.channel == p.pWakeupChannel)
      apply({poc::PocEventKind::kWakeupPatternReceived}, reception.end);
    if (reception.signal == ports::Signal::kFrame && wire::has_header(reception.frame))
      apply({poc::PocEventKind::kHeaderReceived}, reception.end);
  }
  if (clock)
    judge(reception, conflict);
  else if (!conflict)
    receive_startup_frame(reception);
  if (clock) return;
  const bool idle = !port.carrier(Channel::kA) && !port.carrier(Channel::kB);
  if (idle) apply({poc::PocEventKind::kChannelsIdle}, reception.end + bits(kIdleDelimiterBits));
}

// Without a schedule only startup frames matter: two of them make one.
void FlexRayController::State::receive_startup_frame(const ports::Reception& reception) {
  const wire::FrameHeader& header = reception.frame.header;
  if (!is_frame(reception) || !header.startup || !header.sync || header.frame_id > g.gNumberOfStaticSlots ||
      header.payload_words != g.gPayloadLengthStatic)
    return;
  const StartupFrame received{reception.channel, header.frame_id, header.cycle, reception.start};
  const poc::PocEvent event = poc::PocEvent::startup_frame(header.frame_id, header.cycle);
  if (poc.kind == poc::PocKind::kColdstartListen || poc.kind == poc::PocKind::kIntegrationListen) {
    apply(event, reception.end);
    if (poc.kind != poc::PocKind::kInitialiseSchedule) return;
    initialisation.receive(received);
    partner_overdue =
        reception.end + Microticks{p.pMicroPerCycle + p.pRateCorrectionOut + 1} + port.handed_over_within();
  } else if (poc.kind == poc::PocKind::kInitialiseSchedule && received.frame_id == poc.reference) {
    const auto schedule = initialisation.receive(received);
    if (!schedule && received.cycle % 2 == 0) return;  // the other channel's even frame
    partner_overdue = kNever<Microticks>;
    if (!schedule) return apply({poc::PocEventKind::kScheduleNotDerived}, reception.end);
    apply(event, reception.end);
    begin_schedule(schedule->cycle_start, schedule->rate, schedule->cycle);
    start_cycle();
    // Skips the past events of a cycle entered in the middle; this node sends nothing in it anyway.
    while (next_event() <= reception.end && segment == Segment::kStatic && next_static < slots.own_static().size()) {
      ++next_static;
      skip_to_own_static();
    }
  }
}

int FlexRayController::State::look_up_static_slot(Microticks at) {
  const Microticks into = at - clock->cycle_start();
  if (into < Microticks{}) return 0;
  if (into >= grid.back().from) return g.gNumberOfStaticSlots + 1;
  const auto from = [this](int slot) { return line(slot).from; };
  // Tries the next slot first, then an estimate on the nominal grid, off by one slot at most.
  int slot = slot_at.slot + 1;
  if (slot > g.gNumberOfStaticSlots || into < from(slot) || into >= from(slot + 1)) {
    slot = static_cast<int>(std::min<std::int64_t>(nominal_slot.floor(into.value) + 1, g.gNumberOfStaticSlots));
    while (from(slot) > into) --slot;
    while (from(slot + 1) <= into) ++slot;
  }
  slot_at = {slot, clock->cycle_start() + from(slot), clock->cycle_start() + from(slot + 1), counter,
             slots.expected(slot, counter)};
  return slot;
}

// Notes activity that began in `slot` (0: before the cycle) and went on to slot `last` or beyond the segment.
void FlexRayController::State::cross_slots(const ports::Reception& reception, int slot, int last) {
  board.crossed(reception.channel, slot + 1, std::min(last, board.slots()));
  if (last <= board.slots()) return;
  going_on[index_of(reception.channel)] = false;
  count_minislots(reception);
}

// Judges a reception before or after the static segment, as `slot` says.
void FlexRayController::State::judge_elsewhere(const ports::Reception& reception, int slot, SlotStatus errors,
                                               bool conflict) {
  const int minislot = slot == 0 ? 0 : minislots.minislot_at(*clock, reception.start);
  if (minislot >= 1 && minislot <= minislots.count()) return judge_dynamic(reception, minislot, errors);

  // Between the segments, in the symbol window, in the NIT, or from the previous cycle.
  if (slot == 0) {
    going_on[index_of(reception.channel)] = false;
    cross_slots(reception, slot, last_static_slot_of(reception));
  } else if (minislot == 0) {
    count_minislots(reception);
  }
  const Macroticks window = window_start();
  const bool in_window = g.gdSymbolWindow > 0 && slot != 0 && reception.start >= clock->start_of(window) &&
                         reception.end <= clock->start_of(window + Macroticks{g.gdSymbolWindow});
  if (poc::in_startup(poc.kind) || (in_window && is_cas(reception) && !conflict)) return;
  if (!in_window) errors |= kBoundaryViolation;
  events.slot_problem(clock->cycle(), 0, reception.channel, errors | kSyntaxError, reception.end);
}

void FlexRayController::State::judge_static(const ports::Reception& reception, int slot, SlotStatus errors) {
  const auto c = index_of(reception.channel);
  SlotBoard::Seen& status = board.at(slot);
  if (const int last = last_static_slot_of(reception); last != slot) {
    cross_slots(reception, slot, last);
    errors |= kBoundaryViolation;
  }
  if (status.element[c]) errors |= kSyntaxError;  // a second communication element
  status.element[c] = true;
  if (errors == kValidFrame && !is_of_slot(reception.frame.header, slot, slot_at.counter)) errors |= kContentError;
  status.errors[c] |= errors;
  if (errors != kValidFrame) {
    // Activity that outlasts the segment is judged after the segment has been closed.
    if (!board.under_way() && !poc::in_startup(poc.kind))
      events.slot_problem(clock->cycle(), slot, reception.channel, errors, reception.end);
    return;
  }
  status.valid[c] = true;
  accept(reception, reception.channel, slot, slot_at.expected[c]);  // static_slot_at() has just looked it up
}

void FlexRayController::State::accept(const ports::Reception& reception, Channel channel, int slot,
                                      const FrameSlot* expected) {
  const wire::FrameHeader& header = reception.frame.header;
  if (!poc::in_startup(poc.kind)) events.frame_received(clock->cycle(), slot, channel, reception.frame, reception.end);
  if (header.sync)
    receive_sync(reception, slot,
                 channel == Channel::kA ? schedules::model::Channels::kA : schedules::model::Channels::kB);
  if (header.payload_preamble) network_management.combine(reception.frame.payload);
  if (expected != nullptr && (expected->pdu == kNoPdu || store(*expected, reception))) return;
  board.at(slot).errors[index_of(channel)] |= kUnexpectedFrame;
  // As of activity that outlasts the segment, the segment's own report is out.
  if (!board.under_way() && !poc::in_startup(poc.kind))
    events.slot_problem(clock->cycle(), slot, channel, kUnexpectedFrame, reception.end);
}

// The medium reports the arrival of the TSS's first bit, so there is no decoding time to subtract
// (pDecodingCorrection). The schedule compensates the mean propagation delay of the bus.
void FlexRayController::State::receive_sync(const ports::Reception& reception, int slot,
                                            schedules::model::Channels channels) {
  const Microticks late = reception.start - clock->cycle_start() - line(slot).action_point;
  const auto deviation = [&](int compensation) { return static_cast<int>(late.value) - compensation; };
  const std::array<int, 2> deviations{deviation(p.pDelayCompensationA), deviation(p.pDelayCompensationB)};
  const auto starts_up = [&](Channel channel) {
    return includes(channels, channel) && std::abs(deviations[index_of(channel)]) <= p.pdAcceptedStartupRange;
  };
  sync.received(slot, channels, deviations,
                reception.frame.header.startup && (starts_up(Channel::kA) || starts_up(Channel::kB)));
}

// Counts the minislots of a reception, from the first one on if it began before: the slot counter goes on
// after them. Returns the last one; 0 if it ended before the segment.
int FlexRayController::State::count_minislots(const ports::Reception& reception) {
  const int compensation = reception.channel == Channel::kA ? p.pDelayCompensationA : p.pDelayCompensationB;
  const int first = minislots.minislot_at(*clock, reception.start);
  const int last = std::max(first, minislots.minislot_at(*clock, reception.end - Microticks{compensation}));
  if (last == 0 || segment != Segment::kDynamic) return last;
  dynamic[index_of(reception.channel)].counter.occupied(std::max(first, 1), last);
  plan_dynamic(reception.channel, reception.end);
  due = next_event();
  return last;
}

void FlexRayController::State::judge_dynamic(const ports::Reception& reception, int minislot, SlotStatus errors) {
  const wire::FrameHeader& header = reception.frame.header;
  const int slot = dynamic[index_of(reception.channel)].counter.slot_in(minislot);
  if (count_minislots(reception) > minislots.count()) errors |= kBoundaryViolation;

  if (errors == kValidFrame && !is_of_dynamic_slot(header, slot)) errors |= kContentError;
  if (errors == kValidFrame) {
    if (!poc::in_startup(poc.kind))
      events.frame_received(clock->cycle(), slot, reception.channel, reception.frame, reception.end);
    const FrameSlot* expected = slots.expected(slot, counter, reception.channel, wire::message_id(reception.frame));
    if (!is_as_expected(reception.frame, expected) || !store(*expected, reception)) errors |= kUnexpectedFrame;
  }
  if (errors != kValidFrame && !poc::in_startup(poc.kind))
    events.slot_problem(clock->cycle(), slot, reception.channel, errors, reception.end);
}

// Returns whether a valid dynamic frame may hold the fragment that the schedule has there.
bool FlexRayController::State::is_as_expected(const wire::DecodedFrame& received, const FrameSlot* expected) const {
  return expected != nullptr && expected->pdu != kNoPdu &&
         received.header.payload_preamble == expected->message_id.has_value() &&
         received.payload.size() >=
             preamble_bytes(*expected) + static_cast<std::size_t>(cluster.pdu(expected->pdu).fragment_bytes);
}

// Returns false if the frame's payload is no fragment of this slot's list.
bool FlexRayController::State::store(const FrameSlot& slot, const ports::Reception& reception) {
  if (slot.pdu == kNoPdu || reception.frame.header.null_frame || poc::in_startup(poc.kind)) return true;
  cni::IncomingList& list = cni.incoming(slot.pdu);
  const auto bytes = static_cast<std::size_t>(cluster.pdu(slot.pdu).fragment_bytes);
  const cni::ArrivalEffect effect =
      list.arrive(reception.frame.payload.subspan(preamble_bytes(slot), bytes), slot.fragment);
  events.list_arrived(slot.pdu, effect, list.arrived(), list.torn(), reception.end);
  return effect != cni::ArrivalEffect::kMalformed;
}

}  // namespace ttf::bus::controller
