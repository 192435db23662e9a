#include "timebase/oscillator.h"

#include <limits>

#include "core/check.h"

namespace ttf::timebase {
namespace {

constexpr std::int64_t kAttosecondsPerPicosecond = 1'000'000;
constexpr std::int64_t kAttosecondsPerNanosecond = 1'000'000'000;
constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min();

// A clock that is fast by d has the period nominal / (1 + d): rounded once, to the nearest attosecond.
std::int64_t period_as(std::int64_t nominal_period_ps, std::int64_t drift_ppb) {
  TTF_CHECK(drift_ppb >= -Oscillator::kMaxDrift_ppb && drift_ppb <= Oscillator::kMaxDrift_ppb, "drift {} ppb", drift_ppb);
  constexpr std::int64_t kBillion = 1'000'000'000;
  const Int128 numerator = static_cast<Int128>(nominal_period_ps) * kAttosecondsPerPicosecond * kBillion;
  const Int128 denominator = kBillion + drift_ppb;
  const auto period = static_cast<std::int64_t>((numerator + denominator / 2) / denominator);
  TTF_CHECK(period > kAttosecondsPerNanosecond, "period {} as: two ticks in one nanosecond", period);
  return period;
}

}  // namespace

Oscillator::Oscillator(std::int64_t nominal_period_ps, std::int64_t drift_ppb, std::int64_t phase_ps)
    : nominal_period_ps_(nominal_period_ps), changed_{kLongAgo}, changed_tick_{kLongAgo} {
  TTF_CHECK(nominal_period_ps > 1000, "period {} ps", nominal_period_ps);
  TTF_CHECK(phase_ps >= 0 && phase_ps < nominal_period_ps, "phase {} ps", phase_ps);
  line_ = {period_as(nominal_period_ps, drift_ppb), phase_ps * kAttosecondsPerPicosecond};
  before_ = line_;
}

void Oscillator::change_drift(TrueTime now, std::int64_t drift_ppb) {
  TTF_CHECK(now >= changed_, "a change at {} ns after one at {} ns", now.ns, changed_.ns);
  const std::int64_t period = period_as(nominal_period_ps_, drift_ppb);
  const Microticks counted = line_.ticks_at(now);
  const Int128 at = static_cast<Int128>(now.ns) * kAttosecondsPerNanosecond;
  const Int128 next = line_.phase_as + static_cast<Int128>(counted.value + 1) * line_.period_as;
  // In (0, old period] before, so in (0, new period] after: neither a tick more nor one less has been counted by now.
  const Int128 rest = ((next - at) * period + line_.period_as - 1) / line_.period_as;
  // A second change at the same instant leaves the past as the first one found it.
  if (now > changed_) before_ = line_;
  changed_ = now;
  changed_tick_ = counted;
  line_ = {period, at + rest - static_cast<Int128>(counted.value + 1) * period};
}

Microticks Oscillator::ticks_at(TrueTime t) const { return (t <= changed_ ? before_ : line_).ticks_at(t); }
TrueTime Oscillator::time_of(Microticks k) const { return (k <= changed_tick_ ? before_ : line_).time_of(k); }

Microticks Oscillator::Line::ticks_at(TrueTime t) const {
  const Int128 since = static_cast<Int128>(t.ns) * kAttosecondsPerNanosecond - phase_as;
  const Int128 whole = since / period_as;
  return {static_cast<std::int64_t>(since < 0 && whole * period_as != since ? whole - 1 : whole)};
}

TrueTime Oscillator::Line::time_of(Microticks k) const {
  const Int128 at = static_cast<Int128>(k.value) * period_as + phase_as;
  const Int128 whole = at / kAttosecondsPerNanosecond;
  return {static_cast<std::int64_t>(at > 0 && whole * kAttosecondsPerNanosecond != at ? whole + 1 : whole)};
}

LocalTime Oscillator::local_time(Microticks k) const {
  const Int128 ps = static_cast<Int128>(k.value) * nominal_period_ps_;
  const Int128 whole = ps / 1000;
  return {static_cast<std::int64_t>(ps < 0 && whole * 1000 != ps ? whole - 1 : whole)};
}

}  // namespace ttf::timebase
