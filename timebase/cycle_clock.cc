#include "timebase/cycle_clock.h"

#include <limits>

#include "core/check.h"
#include "core/int128.h"
#include "timebase/floor_div.h"

namespace ttf::timebase {
namespace {

constexpr std::int64_t kPicosecondsPerNanosecond = 1000;
constexpr std::int64_t kMost = std::int64_t{1} << 62;  // [ps]; two such values can be added

const CycleGeometry& checked(const CycleGeometry& geometry) {
  TTF_CHECK(geometry.macro_per_cycle > 0 && geometry.micro_per_cycle > 2 * geometry.macro_per_cycle,
            "{} macroticks, {} microticks", geometry.macro_per_cycle, geometry.micro_per_cycle);
  TTF_CHECK(geometry.offset_correction_start > 0 && geometry.offset_correction_start < geometry.macro_per_cycle,
            "offset correction starts at {}", geometry.offset_correction_start);
  return geometry;
}

}  // namespace

CycleClock::CycleClock(CycleGeometry geometry, Microticks start, int rate, std::int64_t first)
    : geometry_(checked(geometry)), macroticks_(geometry.macro_per_cycle),
      late_macroticks_(geometry.macro_per_cycle - geometry.offset_correction_start),
      cycle_ps_(geometry.macro_per_cycle * geometry.macrotick_ps),
      late_ps_((geometry.macro_per_cycle - geometry.offset_correction_start) * geometry.macrotick_ps),
      most_cycles_(kMost / cycle_ps_), first_(first), cycle_(first), start_(start) {
  early_.slope = cycle_ps_;
  early_.overflow = static_cast<std::uint64_t>(kMost / cycle_ps_);
  late_.slope = late_ps_;
  late_.overflow = static_cast<std::uint64_t>(kMost / late_ps_);
  late_.most_ns = std::numeric_limits<std::int64_t>::max();
  set_rate(rate);
  lay_stretches();
}

void CycleClock::set_rate(int rate) {
  rate_ = rate;
  length_ = geometry_.micro_per_cycle + rate;
  before_ = macroticks_.ceil(geometry_.offset_correction_start * length_);
  early_.divisor = Divisor(length_ * kPicosecondsPerNanosecond);
  late_.from = before_;
}

// 64 bits suffice for years of global time.
void CycleClock::lay_stretches() {
  if (cycle_ < 0 || cycle_ >= most_cycles_) {
    early_.reach = late_.reach = 0;
    return;
  }
  const std::int64_t begin_ps = cycle_ps_ * cycle_;
  early_.reach = early_.overflow;
  early_.begin_ns = begin_ps / kPicosecondsPerNanosecond;
  early_.rest = begin_ps % kPicosecondsPerNanosecond * length_;
  early_.most_ns = (begin_ps + cycle_ps_ - late_ps_) / kPicosecondsPerNanosecond;
  lay_late();
}

// A correction that uses up its whole phase fails only when a time in that phase is asked for.
void CycleClock::lay_late() {
  const std::int64_t phase = length_ + offset_ - before_;
  late_.reach = 0;
  if (phase <= 0 || early_.reach == 0) return;
  const std::int64_t begin_ps = cycle_ps_ * cycle_ + cycle_ps_ - late_ps_;
  late_.reach = late_.overflow;
  late_.begin_ns = begin_ps / kPicosecondsPerNanosecond;
  late_.rest = begin_ps % kPicosecondsPerNanosecond * phase;
  late_.divisor = Divisor(phase * kPicosecondsPerNanosecond);
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

GlobalTime CycleClock::exact_global_time(Microticks t) const {
  const std::int64_t into = (t - start_).value;
  TTF_CHECK(into >= 0 || cycle_ == first_, "{} microticks before the cycle", -into);
  // Elapsed picoseconds of the cycle: linear up to the correction phase, then with another slope, also beyond
  // the cycle's end.
  const Int128 at_correction = cycle_ps_ - late_ps_;
  Int128 elapsed_ps = 0;
  if (into <= before_) {
    elapsed_ps = floor_div(static_cast<Int128>(into) * cycle_ps_, length_);
    if (elapsed_ps > at_correction) elapsed_ps = at_correction;  // `before_` is rounded up
  } else {
    elapsed_ps = at_correction + floor_div(static_cast<Int128>(into - before_) * late_ps_, correction_phase());
  }
  // Rounds down, also for instants just before the first cycle.
  return {static_cast<std::int64_t>(
      floor_div(static_cast<Int128>(cycle_ps_) * cycle_ + elapsed_ps, kPicosecondsPerNanosecond))};
}

Microticks CycleClock::when(GlobalTime time) const {
  // Bisection finds the first microtick at or after `time`: global_time is non-decreasing within the cycle.
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
  ++cycle_;
  if (rate != rate_) set_rate(rate);
  lay_stretches();
}

}  // namespace ttf::timebase
