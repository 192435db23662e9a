#include "timebase/cycle_clock.h"

#include "core/check.h"
#include "core/int128.h"

namespace ttf::timebase {
namespace {

std::int64_t ceil_div(std::int64_t a, std::int64_t b) { return (a + b - 1) / b; }
Int128 floor_div(Int128 a, Int128 b) { return a < 0 ? -((b - 1 - a) / b) : a / b; }

}  // namespace

CycleClock::CycleClock(CycleGeometry geometry, Microticks start, int rate, std::int64_t first)
    : geometry_(geometry), first_(first), cycle_(first), start_(start), rate_(rate) {
  TTF_CHECK(geometry.macro_per_cycle > 0 && geometry.micro_per_cycle > 2 * geometry.macro_per_cycle,
            "{} macroticks, {} microticks", geometry.macro_per_cycle, geometry.micro_per_cycle);
  TTF_CHECK(geometry.offset_correction_start > 0 && geometry.offset_correction_start < geometry.macro_per_cycle,
            "offset correction starts at {}", geometry.offset_correction_start);
}

Microticks CycleClock::cycle_end() const { return start_ + Microticks{geometry_.micro_per_cycle + rate_ + offset_}; }

std::int64_t CycleClock::correction_phase() const {
  const std::int64_t length = geometry_.micro_per_cycle + rate_;
  const std::int64_t before = ceil_div(geometry_.offset_correction_start * length, geometry_.macro_per_cycle);
  const std::int64_t rest = length + offset_ - before;
  TTF_CHECK(rest > 0, "a correction by {} leaves {} of {} microticks behind the first {}", offset_, rest, length, before);
  return rest;
}

Microticks CycleClock::start_of(Macroticks m) const {
  TTF_CHECK(m.value >= 0 && m.value <= geometry_.macro_per_cycle, "macrotick {}", m.value);
  const std::int64_t length = geometry_.micro_per_cycle + rate_;
  const std::int64_t correction_start = geometry_.offset_correction_start;
  if (m.value <= correction_start)
    return start_ + Microticks{ceil_div(m.value * length, geometry_.macro_per_cycle)};
  // The rest of the cycle absorbs the offset correction evenly.
  const std::int64_t before = ceil_div(correction_start * length, geometry_.macro_per_cycle);
  return start_ + Microticks{before + ceil_div((m.value - correction_start) * correction_phase(),
                                               geometry_.macro_per_cycle - correction_start)};
}

GlobalTime CycleClock::global_time(Microticks t) const {
  const std::int64_t length = geometry_.micro_per_cycle + rate_;
  const std::int64_t into = (t - start_).value;
  TTF_CHECK(into >= 0 || cycle_ == first_, "{} microticks before the cycle", -into);
  const std::int64_t correction_start = geometry_.offset_correction_start;
  const std::int64_t before = ceil_div(correction_start * length, geometry_.macro_per_cycle);
  // Elapsed picoseconds of the cycle: linear up to the correction phase, linear at another slope in it and, should
  // somebody ask, beyond the cycle's end.
  Int128 elapsed_ps = 0;
  if (into <= before) {
    elapsed_ps = floor_div(static_cast<Int128>(into) * geometry_.macro_per_cycle * geometry_.macrotick_ps, length);
    const Int128 at_correction = static_cast<Int128>(correction_start) * geometry_.macrotick_ps;
    if (elapsed_ps > at_correction) elapsed_ps = at_correction;   // `before` is rounded up
  } else {
    elapsed_ps = static_cast<Int128>(correction_start) * geometry_.macrotick_ps +
                 static_cast<Int128>(into - before) * (geometry_.macro_per_cycle - correction_start) *
                     geometry_.macrotick_ps / correction_phase();
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
  rate_ = rate;
  ++cycle_;
}

}  // namespace ttf::timebase
