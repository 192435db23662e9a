#include "timebase/cycle_clock.h"

#include <algorithm>

#include "core/check.h"
#include "core/int128.h"
#include "timebase/floor_div.h"

namespace ttf::timebase {
namespace {

const CycleGeometry& checked(const CycleGeometry& geometry) {
  TTF_CHECK(geometry.macro_per_cycle > 0 && geometry.micro_per_cycle > 2 * geometry.macro_per_cycle,
            "{} macroticks, {} microticks", geometry.macro_per_cycle, geometry.micro_per_cycle);
  TTF_CHECK(geometry.offset_correction_start > 0 && geometry.offset_correction_start < geometry.macro_per_cycle,
            "offset correction starts at {}", geometry.offset_correction_start);
  return geometry;
}

}  // namespace

CycleClock::CycleClock(CycleGeometry geometry, Microticks start, int rate, std::int64_t first)
    : geometry_(checked(geometry)),
      macroticks_(geometry.macro_per_cycle),
      late_macroticks_(geometry.macro_per_cycle - geometry.offset_correction_start),
      microticks_(geometry.micro_per_cycle),
      cycle_ps_(geometry.macro_per_cycle * geometry.macrotick_ps),
      most_cycles_((std::int64_t{1} << 62) / cycle_ps_),
      first_(first),
      cycle_(first),
      start_(start) {
  set_rate(rate);
}

void CycleClock::set_rate(int rate) {
  rate_ = rate;
  length_ = geometry_.micro_per_cycle + rate;
  microticks_ = Divisor(length_);
  before_ = macroticks_.ceil(geometry_.offset_correction_start * length_);
}

Microticks CycleClock::cycle_end() const { return start_ + Microticks{length_ + offset_}; }

std::int64_t CycleClock::correction_phase() const {
  const std::int64_t rest = length_ + offset_ - before_;
  TTF_CHECK(rest > 0, "a correction by {} leaves {} of {} microticks behind the first {}", offset_, rest, length_,
            before_);
  return rest;
}

// The rest of the cycle absorbs the offset correction evenly.
Microticks CycleClock::late_start_of(Macroticks m) const {
  TTF_CHECK(m.value <= geometry_.macro_per_cycle, "macrotick {}", m.value);
  const std::int64_t late = m.value - geometry_.offset_correction_start;
  return start_ + Microticks{before_ + late_macroticks_.ceil(late * correction_phase())};
}

GlobalTime CycleClock::global_time(Microticks t) const {
  const std::int64_t into = (t - start_).value;
  TTF_CHECK(into >= 0 || cycle_ == first_, "{} microticks before the cycle", -into);
  const std::int64_t correction_start = geometry_.offset_correction_start;
  // Up to the correction phase, and for years to come, 64 bits are enough, and no division is needed.
  if (into >= 0 && into <= before_ && into < most_cycles_ && cycle_ >= 0 && cycle_ < most_cycles_) {
    const std::int64_t elapsed_ps =
        std::min(microticks_.floor(into * cycle_ps_), correction_start * geometry_.macrotick_ps);
    return {(cycle_ps_ * cycle_ + elapsed_ps) / 1000};
  }
  // Elapsed picoseconds of the cycle: linear up to the correction phase, linear at another slope in it and, should
  // somebody ask, beyond the cycle's end.
  Int128 elapsed_ps = 0;
  if (into <= before_) {
    elapsed_ps = floor_div(static_cast<Int128>(into) * geometry_.macro_per_cycle * geometry_.macrotick_ps, length_);
    const Int128 at_correction = static_cast<Int128>(correction_start) * geometry_.macrotick_ps;
    if (elapsed_ps > at_correction) elapsed_ps = at_correction;   // `before_` is rounded up
  } else {
    elapsed_ps = static_cast<Int128>(correction_start) * geometry_.macrotick_ps +
                 floor_div(static_cast<Int128>(into - before_) * (geometry_.macro_per_cycle - correction_start) *
                               geometry_.macrotick_ps,
                           correction_phase());
  }
  const Int128 cycle_ps = static_cast<Int128>(geometry_.macro_per_cycle) * geometry_.macrotick_ps;
  // Rounded down, also for instants just before the first cycle.
  return {static_cast<std::int64_t>(floor_div(cycle_ps * cycle_ + elapsed_ps, 1000))};
}

Microticks CycleClock::when(GlobalTime time) const {
  // global_time is non-decreasing within the cycle: the first microtick at or after `time` by bisection.
  std::int64_t low = start_.value, high = cycle_end().value;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (global_time({middle}) >= time)
      high = middle;
    else
      low = middle + 1;
  }
  return {low};
}

void CycleClock::next_cycle(int rate) {
  start_ = cycle_end();
  offset_ = 0;
  set_rate(rate);
  ++cycle_;
}

}  // namespace ttf::timebase
