#include "timebase/oscillator.h"

#include <limits>

#include "core/check.h"
#include "timebase/floor_div.h"

namespace ttf::timebase {
namespace {

constexpr std::int64_t kAttosecondsPerPicosecond = 1'000'000;
constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min();

// Returns the period of a clock that is fast by d: nominal / (1 + d), rounded once to the nearest attosecond.
std::int64_t period_as(std::int64_t nominal_period_ps, std::int64_t drift_ppb) {
  TTF_CHECK(drift_ppb >= -Oscillator::kMaxDrift_ppb && drift_ppb <= Oscillator::kMaxDrift_ppb, "drift {} ppb",
            drift_ppb);
  constexpr std::int64_t kBillion = 1'000'000'000;
  const Int128 numerator = static_cast<Int128>(nominal_period_ps) * kAttosecondsPerPicosecond * kBillion;
  const Int128 denominator = kBillion + drift_ppb;
  const auto period = static_cast<std::int64_t>((numerator + denominator / 2) / denominator);
  TTF_CHECK(period > kAttosecondsPerNanosecond, "period {} as: two ticks in one nanosecond", period);
  return period;
}

std::int64_t rest_of(Int128 attoseconds, std::int64_t whole_ns) {
  return static_cast<std::int64_t>(attoseconds - static_cast<Int128>(whole_ns) * kAttosecondsPerNanosecond);
}

// a / b in units of 2^-64 for 0 <= a < b, rounded down and up.
std::uint64_t fraction(std::int64_t a, std::int64_t b) {
  return static_cast<std::uint64_t>((static_cast<UInt128>(a) << 64) / static_cast<UInt128>(b));
}
std::uint64_t fraction_up(std::int64_t a, std::int64_t b) {
  return static_cast<std::uint64_t>(((static_cast<UInt128>(a) << 64) + static_cast<UInt128>(b) - 1) /
                                    static_cast<UInt128>(b));
}

}  // namespace

Oscillator::Oscillator(std::int64_t nominal_period_ps, std::int64_t drift_ppb, std::int64_t phase_ps)
    : nominal_period_ps_(nominal_period_ps), changed_{kLongAgo}, changed_tick_{kLongAgo} {
  TTF_CHECK(nominal_period_ps > 1000, "period {} ps", nominal_period_ps);
  TTF_CHECK(phase_ps >= 0 && phase_ps < nominal_period_ps, "phase {} ps", phase_ps);
  line_ = Line(period_as(nominal_period_ps, drift_ppb), phase_ps * kAttosecondsPerPicosecond);
  before_ = line_;
}

void Oscillator::change_drift(TrueTime now, std::int64_t drift_ppb) {
  TTF_CHECK(now >= changed_, "a change at {} ns after one at {} ns", now.ns, changed_.ns);
  const std::int64_t period = period_as(nominal_period_ps_, drift_ppb);
  const Microticks counted = line_.ticks_at(now);
  const Int128 at = static_cast<Int128>(now.ns) * kAttosecondsPerNanosecond;
  const Int128 next = line_.attoseconds(counted + Microticks{1});
  // It was in (0, old period] and is in (0, new period]: no tick is gained or lost by now.
  const Int128 rest = ((next - at) * period + line_.period_as() - 1) / line_.period_as();
  // A second change at the same instant keeps the past of the first one.
  if (now > changed_) before_ = line_;
  changed_ = now;
  changed_tick_ = counted;
  line_ = Line(period, at + rest - static_cast<Int128>(counted.value + 1) * period);
}

Oscillator::Line::Line(std::int64_t period_as, Int128 phase_as)
    : period_as_(period_as), phase_as_(phase_as),
      phase_ns_(static_cast<std::int64_t>(floor_div(phase_as, kAttosecondsPerNanosecond))),
      period_ns_(period_as / kAttosecondsPerNanosecond),
      phase_rest_(fraction(rest_of(phase_as, phase_ns_), kAttosecondsPerNanosecond)),
      period_rest_(fraction(rest_of(period_as, period_ns_), kAttosecondsPerNanosecond)),
      frequency_(fraction(kAttosecondsPerNanosecond, period_as)),
      phase_ticks_(fraction_up(rest_of(phase_as, phase_ns_), period_as)) {}

Microticks Oscillator::Line::ticks_before(TrueTime t) const {
  const Int128 at = static_cast<Int128>(t.ns) * kAttosecondsPerNanosecond;
  return {static_cast<std::int64_t>(floor_div(at - phase_as_, period_as_))};
}

TrueTime Oscillator::Line::time_before(Microticks k) const {
  return {static_cast<std::int64_t>(-floor_div(-attoseconds(k), kAttosecondsPerNanosecond))};
}

TrueTime Oscillator::Line::time_from(TrueTime t, Microticks k) const {
  while (lateness(k, t) < 0) ++t.ns;
  return t;
}

LocalTime Oscillator::local_time(Microticks k) const {
  return {static_cast<std::int64_t>(floor_div(static_cast<Int128>(k.value) * nominal_period_ps_, 1000))};
}

}  // namespace ttf::timebase
