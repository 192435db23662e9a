#include "bus/controller/dynamic_segment.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::bus::controller {
namespace {

constexpr int kSlotIdMax = 2047;  // cSlotIDMax

}  // namespace

DynamicSlotCounter::DynamicSlotCounter(const schedules::model::GlobalParameters& flexray)
    : first_slot_(flexray.gNumberOfStaticSlots + 1), idle_phase_(flexray.gdDynamicSlotIdlePhase) {
  start();
}

void DynamicSlotCounter::start() {
  slot_ = first_slot_;
  minislot_ = 1;
}

int DynamicSlotCounter::slot_in(int minislot) const {
  if (minislot < minislot_) return 0;
  const int slot = slot_ + minislot - minislot_;
  return slot > kSlotIdMax ? 0 : slot;
}

int DynamicSlotCounter::minislot_of(int slot) const { return slot < slot_ ? 0 : minislot_ + slot - slot_; }

void DynamicSlotCounter::occupied(int first, int last) {
  TTF_CHECK(first >= 1 && last >= first, "minislots {} to {}", first, last);
  if (first >= minislot_) slot_ += first - minislot_ + 1;  // the slot in `first`, and on to the next
  minislot_ = std::max(minislot_, last + 1 + idle_phase_);
}

MinislotGrid::MinislotGrid(const schedules::model::GlobalParameters& flexray)
    : count_(flexray.gNumberOfMinislots), length_(flexray.gdMinislot),
      action_point_(flexray.gdMinislotActionPointOffset) {
  // adActionPointDifference: the segment's first action point lies no earlier than that of a static slot would.
  const int difference = std::max(0, flexray.gdActionPointOffset - flexray.gdMinislotActionPointOffset);
  first_macrotick_ = flexray.gNumberOfStaticSlots * flexray.gdStaticSlot + difference;
}

Macroticks MinislotGrid::start_of(int minislot) const {
  return {first_macrotick_ + static_cast<std::int64_t>(minislot - 1) * length_};
}

Macroticks MinislotGrid::action_point(int minislot) const { return start_of(minislot) + Macroticks{action_point_}; }

int MinislotGrid::minislot_at(const timebase::CycleClock& clock, Microticks at) const {
  if (count_ == 0 || at < clock.start_of(start_of(1))) return 0;
  int low = 1, high = count_ + 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (clock.start_of(start_of(middle)) <= at)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

int MinislotGrid::dts_end(const timebase::CycleClock& clock, Microticks frame_end, Microticks shortest_dts) const {
  const Microticks earliest = frame_end + shortest_dts;
  int minislot = std::max(1, minislot_at(clock, earliest));
  while (minislot <= count_ && clock.start_of(action_point(minislot)) < earliest) ++minislot;
  return minislot;
}

}  // namespace ttf::bus::controller
