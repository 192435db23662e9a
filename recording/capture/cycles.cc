#include "recording/capture/cycles.h"

#include <algorithm>
#include <cmath>

namespace ttf::recording::capture {
namespace {

// In cycles. If stamps are too coarse for a judgement (wrong_slots.h), a frame in a wrong slot may be off by
// the whole static segment and still be in the right cycle.
constexpr double kSameCycle = 0.75;
constexpr double kWellStamped = 0.1;
constexpr int kMostAstray = 4;

}  // namespace

CycleTracker::CycleTracker(const schedules::model::GlobalParameters& flexray)
    : flexray_(flexray), cycle_ns_(flexray.cycle_ps() / 1000), counters_(flexray.gCycleCountMax + 1) {}

std::int64_t CycleTracker::offset_ns(int slot) const {
  if (slot <= flexray_.gNumberOfStaticSlots) return static_slot_offset_ns(flexray_, slot);
  // A dynamic frame is somewhere in its segment: take the middle.
  return static_slot_offset_ns(flexray_, flexray_.gNumberOfStaticSlots + 1) +
         std::int64_t{flexray_.gNumberOfMinislots} * flexray_.gdMinislot / 2 * flexray_.gdMacrotick_ps / 1000;
}

CycleTracker::Place CycleTracker::place_by_counter(int counter) {
  const int ahead = (counter - counter_ + counters_) % counters_;
  const Place place{ahead <= 1 ? ahead : 0, ahead <= 1 ? counter : (counter_ + 1) % counters_, ahead <= 1};
  counter_ = counter;
  return place;
}

bool CycleTracker::disagrees_for_a_cycle(int by, std::int64_t advance) {
  if (disagreement_ != by)
    disagreed_cycles_ = 0;
  else
    disagreed_cycles_ += advance;
  disagreement_ = by;
  return disagreed_cycles_ > 0;
}

CycleTracker::Place CycleTracker::place(int slot, int counter, std::optional<std::int64_t> time_ns) {
  counter %= counters_;
  const auto begin = time_ns ? std::optional(*time_ns - offset_ns(slot)) : std::nullopt;
  if (!started_) {
    started_ = true;
    counter_ = counter;
    start_ = begin;
    return {0, counter, true};
  }
  if (!begin || !start_) return place_by_counter(counter);

  const double passed = static_cast<double>(*begin - *start_) / static_cast<double>(cycle_ns_);
  const double drift = kClockDeviation * std::abs(passed);
  const int ahead = (counter - counter_ + counters_) % counters_;
  const double nearest = ahead + counters_ * std::round((passed - ahead) / counters_);
  Place place;
  place.counter_fits = nearest >= 0 && std::abs(nearest - passed) <= kSameCycle + drift;
  place.advance = static_cast<std::int64_t>(std::max(0.0, place.counter_fits ? nearest : std::round(passed)));
  place.counter = static_cast<int>((counter_ + place.advance % counters_) % counters_);
  counter_ = place.counter;

  const bool well_stamped = std::abs(static_cast<double>(place.advance) - passed) <= kWellStamped + drift;
  astray_ = well_stamped ? 0 : astray_ + 1;
  if (well_stamped || astray_ >= kMostAstray)
    start_ = begin;
  else
    *start_ += place.advance * cycle_ns_;

  if (place.counter_fits)
    disagreement_.reset();
  else if (disagrees_for_a_cycle((counter - place.counter + counters_) % counters_, place.advance))
    counter_ = counter;
  return place;
}

}  // namespace ttf::recording::capture
