#include "nodes/runner/arrival_window.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/check.h"
#include "timebase/floor_div.h"

namespace ttf::nodes::runner {
namespace {

using Kind = bus::ports::LiveArrival::Kind;
constexpr Microticks kNotDue{std::numeric_limits<std::int64_t>::max()};
constexpr std::int64_t kNotReceived = -1;

Microticks bits(const schedules::model::GlobalParameters& g, const schedules::model::NodeParameters& p, int count) {
  return {(count * g.gdBit_ps + p.pdMicrotick_ps - 1) / p.pdMicrotick_ps};
}

// Returns the largest distance from the action point with three properties. A sync frame is within its slot. A
// startup frame is near enough to be one. A midpoint of such deviations can be corrected.
Microticks reach_of(const schedules::model::GlobalParameters& g, const schedules::model::NodeParameters& p) {
  const std::int64_t macrotick = g.gdMacrotick_ps / p.pdMicrotick_ps;
  const std::int64_t behind = (g.gdStaticSlot - g.gdActionPointOffset) * macrotick -
                              bits(g, p, schedules::model::frame_bits(g, g.gPayloadLengthStatic)).value -
                              std::max(p.pDelayCompensationA, p.pDelayCompensationB) - macrotick;
  const std::int64_t before = g.gdActionPointOffset * macrotick - macrotick;
  return {std::max<std::int64_t>(0, std::min({behind, before, static_cast<std::int64_t>(p.pdAcceptedStartupRange),
                                              static_cast<std::int64_t>(p.pOffsetCorrectionOut)}))};
}

HeldStage after(HeldStage stage, HeldEvent event) {
  const auto next = next_stage(stage, event);
  TTF_CHECK(next.has_value(), "event {} in stage {}", static_cast<int>(event), static_cast<int>(stage));
  return *next;
}

}  // namespace

ArrivalWindow::ArrivalWindow(const schedules::model::Cluster& cluster, NodeId node, Width width, ArrivalEvents& events)
    : cluster_(cluster), parameters_(cluster.node(node).flexray ? &*cluster.node(node).flexray : nullptr),
      slots_(cluster, node), width_(width), events_(events), pool_(kMost) {
  if (parameters_ != nullptr) reach_ = reach_of(cluster.flexray, *parameters_);
  free_.reserve(kMost);
  used_.reserve(kMost);
  for (std::size_t i = kMost; i > 0; --i) free_.push_back(static_cast<std::uint16_t>(i - 1));
  for (auto& slots : deviations_) slots.resize(static_cast<std::size_t>(cluster.flexray.gNumberOfStaticSlots));
  for (auto& slots : received_)
    slots.assign(static_cast<std::size_t>(cluster.flexray.gNumberOfStaticSlots), kNotReceived);
}

void ArrivalWindow::arrive(const bus::ports::LiveArrival& arrival, Microticks at, std::optional<Microticks> late,
                           Microticks duration, const timebase::CycleClock* clock) {
  if (arrival.kind == Kind::kFollowUp) return follow_up(arrival, late.value_or(Microticks{}), clock);
  if (free_.empty()) {
    ++dropped_;
    return;
  }
  const std::uint16_t index = free_.back();
  Held& held = pool_[index];
  held.kind = arrival.kind;
  held.order = order_++;
  held.at = held.due = at;
  held.late = late;
  held.stage = HeldStage::kPlaced;
  std::span<const std::byte> bytes;
  if (arrival.kind == Kind::kCan) {
    held.can_bus = arrival.can_bus;
    held.identifier = arrival.can.identifier;
    held.flexible_data_rate = arrival.can.flexible_data_rate;
    bytes = arrival.can.data;
  } else {
    held.channel = arrival.signal.channel;
    held.signal = arrival.signal.signal;
    held.slot = arrival.signal.slot;
    bytes = arrival.signal.bytes;
  }
  TTF_CHECK(bytes.size() <= held.bytes.size(), "{} bytes", bytes.size());
  std::copy(bytes.begin(), bytes.end(), held.bytes.begin());
  held.size = bytes.size();
  if (held.kind == Kind::kFlexRay) {
    if (parameters_ == nullptr) return;
    // A frame is placed when the node reaches the instant of its arrival: only then is its clock at that instant known.
    if (held.signal == bus::ports::Signal::kFrame)
      held.stage = HeldStage::kArrived;
    else
      place_as_it_came(held, duration);
  }
  free_.pop_back();
  used_.push_back(index);
}

void ArrivalWindow::follow_up(const bus::ports::LiveArrival& arrival, Microticks late,
                              const timebase::CycleClock* clock) {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    Held& held = pool_[used_[i]];
    if (held.kind != Kind::kFlexRay || held.stage == HeldStage::kPlaced || held.late ||
        held.channel != arrival.signal.channel || held.slot != arrival.signal.slot)
      continue;
    const auto header = bus::wire::header_of(held.content());
    if (!header || header->cycle != arrival.cycle_counter) continue;
    held.late = late;
    const bool awaited = held.stage == HeldStage::kAwaitsFollowUp;
    held.stage = after(held.stage, HeldEvent::kFollowUp);
    if (awaited) place(held, find(held, clock), clock);
    if (held.stage == HeldStage::kRefused) drop(i);
    return;
  }
}

Microticks ArrivalWindow::length_of(const Held& frame) const {
  return bits(cluster_.flexray, *parameters_,
              schedules::model::frame_bits(cluster_.flexray, bus::wire::words_in_frame(frame.size)));
}

ArrivalWindow::Found ArrivalWindow::find(const Held& frame, const timebase::CycleClock* clock) const {
  const schedules::model::GlobalParameters& g = cluster_.flexray;
  const auto header = bus::wire::header_of(frame.content());
  const bool of_a_slot = header && bus::wire::header_crc_holds(*header) && header->frame_id == frame.slot &&
                         frame.slot >= 1 && frame.slot <= g.gNumberOfStaticSlots;
  if (!of_a_slot) return {HeldEvent::kWithoutSlot};
  if (header->sync && !frame.late && frame.stage == HeldStage::kArrived) return {HeldEvent::kLatenessUnknown};
  if (clock == nullptr) return {HeldEvent::kWithoutSlot};
  const std::int64_t round = g.gCycleCountMax + 1;
  // The possible cycle nearest to the arrival counts; the counter alone could mean a round before.
  const std::int64_t passed = timebase::floor_div((frame.at - clock->cycle_start()).value, parameters_->pMicroPerCycle);
  std::int64_t off = (header->cycle - (clock->cycle() + passed) % round + 2 * round) % round;
  if (off > round / 2) off -= round;
  const std::int64_t ahead = passed + off;
  if (ahead == 1) return {HeldEvent::kOfNextCycle};
  if (ahead > 1 || off > 1 || off < -1) return {HeldEvent::kWithoutSlot};  // the controller will report it
  const Macroticks action_point{static_cast<std::int64_t>(frame.slot - 1) * g.gdStaticSlot + g.gdActionPointOffset};
  Found found;
  found.sync = header->sync;
  found.cycle = clock->cycle() + ahead;
  found.expected = clock->start_of(action_point) + Microticks{ahead * parameters_->pMicroPerCycle};
  found.behind = frame.at - found.expected;
  const bool in_window = ahead == 0 && found.behind <= width_.late && found.behind >= -width_.early;
  found.event = in_window ? HeldEvent::kInWindow : HeldEvent::kOutsideWindow;
  return found;
}

void ArrivalWindow::place(Held& frame, const Found& found, const timebase::CycleClock* clock) {
  frame.stage = after(frame.stage, found.event);
  switch (found.event) {
    case HeldEvent::kLatenessUnknown: frame.due = frame.at + width_.late; break;
    // Due after the begin of its cycle, if the clock announces that begin by then.
    case HeldEvent::kOfNextCycle: frame.due = clock->cycle_end() + Microticks{1}; break;
    case HeldEvent::kInWindow:
    case HeldEvent::kOutsideWindow: place_in_slot(frame, found); break;
    case HeldEvent::kWithoutSlot:
      if (clock == nullptr) forget_cycles();
      place_as_it_came(frame, length_of(frame));
      break;
    case HeldEvent::kFollowUp:
    case HeldEvent::kEnded:
    case HeldEvent::kCycleOver: break;  // find() does not return these
  }
}

void ArrivalWindow::place_as_it_came(Held& held, Microticks length) {
  held.start = held.at - held.late.value_or(Microticks{});
  held.end = held.due = held.start + length;
}

void ArrivalWindow::place_in_slot(Held& frame, const Found& found) {
  count_gap(found.cycle, frame.slot, frame.channel);
  events_.arrived(found.behind);
  if (found.event == HeldEvent::kOutsideWindow)
    return events_.missed_window(found.cycle, frame.slot, frame.channel, found.behind);
  const bool on_a = frame.channel == schedules::model::Channel::kA;
  const Microticks travelled{on_a ? parameters_->pDelayCompensationA : parameters_->pDelayCompensationB};
  Microticks deviation{};
  if (found.sync && frame.late)
    deviation = within_reach(found.behind - *frame.late, found.cycle, frame.slot, frame.channel);
  frame.start = found.expected + travelled + deviation;
  frame.end = frame.due = frame.start + length_of(frame);
}

// Odd cycles measure offsets; rates are the difference of an odd cycle's deviation from the even one before.
Microticks ArrivalWindow::within_reach(Microticks deviation, std::int64_t cycle, int slot,
                                       schedules::model::Channel channel) {
  Deviation& last = deviations_[index_of(channel)][static_cast<std::size_t>(slot - 1)];
  const bool second = cycle % 2 == 1 && last.cycle == cycle - 1;
  const Microticks most = reach_ - Microticks{reach_.value / 8};
  const Microticks put =
      second ? std::clamp(last.put + (deviation - last.measured), -reach_, reach_) : std::clamp(deviation, -most, most);
  last = {cycle, deviation, put};
  return put;
}

void ArrivalWindow::count_gap(std::int64_t cycle, int slot, schedules::model::Channel channel) {
  std::int64_t& last = received_[index_of(channel)][static_cast<std::size_t>(slot - 1)];
  const std::int64_t before = std::exchange(last, std::max(last, cycle));
  if (before == kNotReceived || cycle - before > kLongestGap) return;
  const int round = cluster_.flexray.gCycleCountMax + 1;
  std::uint32_t lost = 0;
  for (std::int64_t c = before + 1; c < cycle; ++c)
    lost += slots_.expected(slot, static_cast<int>(c % round), channel) != nullptr ? 1 : 0;
  if (lost > 0) events_.lost(cycle, slot, channel, lost);
}

// A new clock counts cycles anew.
void ArrivalWindow::forget_cycles() {
  for (auto& cycles : received_) std::fill(cycles.begin(), cycles.end(), kNotReceived);
  for (auto& deviations : deviations_) std::fill(deviations.begin(), deviations.end(), Deviation{});
}

void ArrivalWindow::drop(std::size_t place) {
  free_.push_back(used_[place]);
  used_.erase(used_.begin() + static_cast<std::ptrdiff_t>(place));
}

Microticks ArrivalWindow::next() const {
  Microticks next = kNotDue;
  for (const std::uint16_t index : used_) next = std::min(next, pool_[index].due);
  return next;
}

std::optional<ArrivalWindow::Due> ArrivalWindow::take(Microticks now, const timebase::CycleClock* clock) {
  if (handed_over_) free_.push_back(*handed_over_);
  handed_over_.reset();
  while (!used_.empty()) {
    const auto first = std::min_element(used_.begin(), used_.end(), [this](std::uint16_t a, std::uint16_t b) {
      return std::pair(pool_[a].due, pool_[a].order) < std::pair(pool_[b].due, pool_[b].order);
    });
    Held& held = pool_[*first];
    if (held.due > now) return std::nullopt;
    if (held.stage != HeldStage::kPlaced) {
      Found found = find(held, clock);
      // The clock's cycle should be over and is not: waiting for the next one is useless.
      if (found.event == HeldEvent::kOfNextCycle && clock->cycle_end() < now) found.event = HeldEvent::kWithoutSlot;
      place(held, found, clock);
    } else {
      // Placed before the node had this clock, or late: its cycle is over, and the controller can no longer use it.
      const bool over = held.kind == Kind::kFlexRay && clock != nullptr && held.end < clock->cycle_start();
      if (over && held.signal == bus::ports::Signal::kFrame)
        events_.missed_window(clock->cycle(), held.slot, held.channel, clock->cycle_start() - held.start);
      held.stage = after(held.stage, over ? HeldEvent::kCycleOver : HeldEvent::kEnded);
    }
    if (held.stage == HeldStage::kRefused) drop(static_cast<std::size_t>(first - used_.begin()));
    if (held.stage != HeldStage::kHandedOver) continue;
    handed_over_ = *first;
    used_.erase(first);
    Due due;
    due.kind = held.kind;
    due.at = held.at;
    const std::span<const std::byte> bytes = held.content();
    if (held.kind == Kind::kCan) {
      due.can_bus = held.can_bus;
      due.can = {held.identifier, held.flexible_data_rate, bytes};
    } else {
      due.reception = {held.channel, held.signal, held.start, held.end,
                       held.signal == bus::ports::Signal::kFrame ? bus::wire::decode_frame(held.channel, bytes)
                                                                 : bus::wire::DecodedFrame{}};
    }
    return due;
  }
  return std::nullopt;
}

bool ArrivalWindow::carrier(schedules::model::Channel channel, Microticks now) const {
  return std::any_of(used_.begin(), used_.end(), [&](std::uint16_t index) {
    const Held& held = pool_[index];
    return held.kind == Kind::kFlexRay && held.stage == HeldStage::kPlaced && held.channel == channel &&
           held.start <= now && held.due > now;
  });
}

}  // namespace ttf::nodes::runner
