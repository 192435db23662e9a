#include "timebase/oscillator.h"

#include "core/check.h"
#include "core/int128.h"

namespace ttf::timebase {
namespace {

constexpr std::int64_t kAttosecondsPerPicosecond = 1'000'000;
constexpr std::int64_t kAttosecondsPerNanosecond = 1'000'000'000;

}  // namespace

Oscillator::Oscillator(std::int64_t nominal_period_ps, std::int64_t drift_ppb, std::int64_t phase_ps)
    : nominal_period_ps_(nominal_period_ps), phase_as_(phase_ps * kAttosecondsPerPicosecond) {
  TTF_CHECK(nominal_period_ps > 1000, "period {} ps", nominal_period_ps);
  TTF_CHECK(drift_ppb >= -1'500'000 && drift_ppb <= 1'500'000, "drift {} ppb", drift_ppb);
  TTF_CHECK(phase_ps >= 0 && phase_ps < nominal_period_ps, "phase {} ps", phase_ps);
  // A clock that is fast by d has the period nominal / (1 + d): rounded once, to the nearest attosecond.
  constexpr std::int64_t kBillion = 1'000'000'000;
  const Int128 numerator = static_cast<Int128>(nominal_period_ps) * kAttosecondsPerPicosecond * kBillion;
  const Int128 denominator = kBillion + drift_ppb;
  period_as_ = static_cast<std::int64_t>((numerator + denominator / 2) / denominator);
  TTF_CHECK(period_as_ > kAttosecondsPerNanosecond, "period {} as: two ticks in one nanosecond", period_as_);
}

Microticks Oscillator::ticks_at(TrueTime t) const {
  const Int128 since = static_cast<Int128>(t.ns) * kAttosecondsPerNanosecond - phase_as_;
  const Int128 whole = since / period_as_;
  return {static_cast<std::int64_t>(since < 0 && whole * period_as_ != since ? whole - 1 : whole)};
}

TrueTime Oscillator::time_of(Microticks k) const {
  const Int128 at = static_cast<Int128>(k.value) * period_as_ + phase_as_;
  const Int128 whole = at / kAttosecondsPerNanosecond;
  return {static_cast<std::int64_t>(at > 0 && whole * kAttosecondsPerNanosecond != at ? whole + 1 : whole)};
}

LocalTime Oscillator::local_time(Microticks k) const {
  const Int128 ps = static_cast<Int128>(k.value) * nominal_period_ps_;
  const Int128 whole = ps / 1000;
  return {static_cast<std::int64_t>(ps < 0 && whole * 1000 != ps ? whole - 1 : whole)};
}

}  // namespace ttf::timebase
