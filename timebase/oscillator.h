// A node's oscillator: a free-running counter of microticks that is exactly periodic in true time.
//
// Tick k happens at   phase + k * period,   both whole attoseconds (10^-18 s), so no error accumulates: a 12.5 ns
// microtick that is 137.25 ppm fast has an integer period, and tick 10^12 is as exact as tick 1.
// True time is in whole nanoseconds; the TrueTime of a tick is the first nanosecond at or after it:
//   L1  ticks_at(time_of(k)) == k            for periods above 1 ns
//   L2  time_of is strictly increasing, ticks_at is non-decreasing
//   L3  time_of(k) - (phase + k * period) is in [0, 1) ns for every k
//   L4  change_drift(t, ...) does not change the past: ticks_at up to t and time_of up to tick ticks_at(t) stay as they
//       were. The rest of the current period is scaled to the new period, rounded up to an attosecond. L1 to L3 hold
//       on, with another phase and period
//
// Only the last change is remembered: for times before it the clock counts as having always run at the rate before it.
#pragma once

#include <cstdint>

#include "core/int128.h"
#include "core/time.h"

namespace ttf::timebase {

inline constexpr std::int64_t kAttosecondsPerNanosecond = 1'000'000'000;

class Oscillator {
 public:
  // The bound for a faulty crystal. The schedule checks the specification's +-1'500 ppm.
  static constexpr std::int64_t kMaxDrift_ppb = 100'000'000;

  // nominal_period_ps: the microtick (12'500, 25'000, ...). drift_ppb: relative deviation of the frequency,
  // positive for a fast clock, within +-kMaxDrift_ppb. phase_ps: true time of tick 0, in [0, nominal period).
  Oscillator(std::int64_t nominal_period_ps, std::int64_t drift_ppb, std::int64_t phase_ps);

  // Sets the drift to `drift_ppb` from `now` on. `now` is never before an earlier change.
  void change_drift(TrueTime now, std::int64_t drift_ppb);

  // Returns the number of ticks up to and including t.
  Microticks ticks_at(TrueTime t) const { return (t <= changed_ ? before_ : line_).ticks_at(t); }
  // Returns the first nanosecond at or after tick k.
  TrueTime time_of(Microticks k) const { return (k <= changed_tick_ ? before_ : line_).time_of(k); }
  LocalTime local_time(Microticks k) const;  // k nominal periods, rounded down to whole nanoseconds
  std::int64_t nominal_period_ps() const { return nominal_period_ps_; }

 private:
  // phase + k * period, in attoseconds of true time. Both conversions multiply fixed-point numbers with 64
  // fractional bits. The product falls short of the exact result by less than 1 / 2^64 per factor and addend.
  // Its whole part is therefore right, except for products just below a whole number; for these an exact
  // remainder decides. A 128-bit division per conversion would take most of a simulation's time.
  class Line {
   public:
    Line() = default;
    Line(std::int64_t period_as, Int128 phase_as);
    Microticks ticks_at(TrueTime t) const {
      if (t.ns < phase_ns_) return ticks_before(t);
      const std::uint64_t since = static_cast<std::uint64_t>(t.ns) - static_cast<std::uint64_t>(phase_ns_);
      const UInt128 ticks = static_cast<UInt128>(since) * frequency_;
      const auto part = static_cast<std::uint64_t>(ticks);
      const auto k = static_cast<std::int64_t>((ticks >> 64) - (part < phase_ticks_ ? 1 : 0));
      // The exact result is in [k + rest, k + rest + since + 1), with rests in units of 2^-64.
      const std::uint64_t rest = part - phase_ticks_;
      if (rest <= ~since) return {k};
      return {lateness({k + 1}, t) >= 0 ? k + 1 : k};
    }
    TrueTime time_of(Microticks k) const {
      const auto ticks = static_cast<std::uint64_t>(k.value);
      const UInt128 rest = static_cast<UInt128>(ticks) * period_rest_ + phase_rest_;
      const std::uint64_t ns = static_cast<std::uint64_t>(phase_ns_) + ticks * static_cast<std::uint64_t>(period_ns_) +
                               static_cast<std::uint64_t>(rest >> 64);
      // The exact rest is in [rest, rest + ticks + 1) / 2^64 and is rounded up. The sign is tested last: if the
      // compiler had it earlier, it would use a wider multiplication.
      if (static_cast<std::uint64_t>(rest) - 1 < ~ticks && k.value >= 0) return {static_cast<std::int64_t>(ns + 1)};
      return k.value < 0 ? time_before(k) : time_from({static_cast<std::int64_t>(ns)}, k);
    }
    // Returns phase + k * period.
    Int128 attoseconds(Microticks k) const { return phase_as_ + static_cast<Int128>(k.value) * period_as_; }
    std::int64_t period_as() const { return period_as_; }

   private:
    Microticks ticks_before(TrueTime t) const;           // before the phase, rounded down to a nanosecond
    TrueTime time_before(Microticks k) const;            // before tick 0
    TrueTime time_from(TrueTime t, Microticks k) const;  // for a result at t or little later
    // Returns t - (phase + k * period) when it is small: it then fits 64 bits even if the terms overflow.
    std::int64_t lateness(Microticks k, TrueTime t) const {
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(t.ns) * kAttosecondsPerNanosecond -
                                       static_cast<std::uint64_t>(phase_as_) -
                                       static_cast<std::uint64_t>(k.value) * static_cast<std::uint64_t>(period_as_));
    }

    std::int64_t period_as_ = 0;
    Int128 phase_as_ = 0;
    std::int64_t phase_ns_ = 0, period_ns_ = 0;       // rounded down
    std::uint64_t phase_rest_ = 0, period_rest_ = 0;  // their rests, in units of 2^-64 ns, rounded down
    std::uint64_t frequency_ = 0;                     // ticks per ns, in units of 2^-64, rounded down
    std::uint64_t phase_ticks_ = 0;                   // the phase's rest, in units of 2^-64 ticks, rounded up
  };

  std::int64_t nominal_period_ps_;
  Line line_, before_;  // `before_` is valid up to and including `changed_`
  TrueTime changed_;
  Microticks changed_tick_;  // before_.ticks_at(changed_)
};

}  // namespace ttf::timebase
