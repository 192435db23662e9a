// A node's oscillator: a free-running counter of microticks that is exactly periodic in true time.
//
// Tick k happens at   phase + k * period,   both whole attoseconds (10^-18 s), so that nothing ever accumulates: a
// 12.5 ns microtick that is 137.25 ppm fast is an integer period, and tick 10^12 is as exact as tick 1.
// True time is whole nanoseconds; a tick's TrueTime is the first nanosecond at or after it:
//   L1  ticks_at(time_of(k)) == k            for periods above 1 ns
//   L2  time_of is strictly increasing, ticks_at is non-decreasing
//   L3  time_of(k) - (phase + k * period) is in [0, 1) ns for every k
#pragma once

#include <cstdint>

#include "core/time.h"

namespace ttf::timebase {

class Oscillator {
 public:
  // nominal_period_ps: the microtick (12'500, 25'000, ...). drift_ppb: relative deviation of the frequency, positive is
  // fast, within +-1'500'000. phase_ps: true time of tick 0, in [0, nominal period).
  Oscillator(std::int64_t nominal_period_ps, std::int64_t drift_ppb, std::int64_t phase_ps);

  Microticks ticks_at(TrueTime t) const;      // ticks that have happened up to and including t
  TrueTime time_of(Microticks k) const;       // first nanosecond at or after tick k
  LocalTime local_time(Microticks k) const;   // k nominal periods, rounded down to whole nanoseconds
  std::int64_t nominal_period_ps() const { return nominal_period_ps_; }

 private:
  std::int64_t nominal_period_ps_;
  std::int64_t period_as_;
  std::int64_t phase_as_;
};

}  // namespace ttf::timebase
