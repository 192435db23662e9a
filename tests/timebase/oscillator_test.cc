#include "timebase/oscillator.h"

#include <gtest/gtest.h>

#include "core/int128.h"
#include "core/random.h"

namespace ttf::timebase {
namespace {

struct Drawn {
  std::int64_t nominal_ps, drift_ppb, phase_ps;
  Oscillator oscillator() const { return {nominal_ps, drift_ppb, phase_ps}; }
  // Where the law says tick k is, computed here: phase + k * (nominal / (1 + drift) rounded to an attosecond).
  Int128 attoseconds(std::int64_t k) const {
    const Int128 top = static_cast<Int128>(nominal_ps) * 1'000'000 * 1'000'000'000;
    const Int128 bottom = 1'000'000'000 + drift_ppb;
    const Int128 period = (2 * top + bottom) / (2 * bottom);
    return period * k + static_cast<Int128>(phase_ps) * 1'000'000;
  }
};

// Periods from the shortest above 1 ns to 1 us, drifts over the whole range, phases anywhere.
Drawn draw(RandomStream& stream) {
  constexpr std::int64_t kUsual[] = {12'500, 25'000, 50'000};
  const std::int64_t nominal =
      stream.integer(0, 1) == 0 ? kUsual[stream.integer(0, 2)] : stream.integer(1'002, 1'000'000);
  return {nominal, stream.integer(-1'500'000, 1'500'000), stream.integer(0, nominal - 1)};
}

template <class Law>
void for_drawn_ticks(std::uint16_t entity, Law law) {
  RandomStream stream({1, 0, Purpose::kTest, entity, 0});
  for (int clock = 0; clock < 300; ++clock) {
    const Drawn drawn = draw(stream);
    const Oscillator oscillator = drawn.oscillator();
    for (int i = 0; i < 100; ++i) {
      const std::int64_t reach = std::int64_t{1} << stream.integer(0, 42);
      law(drawn, oscillator, stream.integer(-reach, reach));
    }
  }
}

TEST(OscillatorLaws, L1_TicksAtInvertsTimeOf) {
  for_drawn_ticks(1, [](const Drawn& drawn, const Oscillator& oscillator, std::int64_t k) {
    ASSERT_EQ(oscillator.ticks_at(oscillator.time_of({k})).value, k) << drawn.nominal_ps << " " << drawn.drift_ppb;
    // One nanosecond earlier it has not happened yet.
    ASSERT_EQ(oscillator.ticks_at(oscillator.time_of({k}) - Duration{1}).value, k - 1);
  });
}

TEST(OscillatorLaws, L2_TimeOfIncreasesAndTicksAtDoesNotDecrease) {
  for_drawn_ticks(2, [](const Drawn&, const Oscillator& oscillator, std::int64_t k) {
    const TrueTime at = oscillator.time_of({k});
    ASSERT_LT(at, oscillator.time_of({k + 1}));
    Microticks before = oscillator.ticks_at(at - Duration{3});
    for (int ns = -2; ns <= 3; ++ns) {
      const Microticks now = oscillator.ticks_at(at + Duration{ns});
      ASSERT_GE(now, before);
      before = now;
    }
  });
}

TEST(OscillatorLaws, L3_TimeOfIsTheFirstNanosecondAtOrAfterTheTick) {
  for_drawn_ticks(3, [](const Drawn& drawn, const Oscillator& oscillator, std::int64_t k) {
    const Int128 late = static_cast<Int128>(oscillator.time_of({k}).ns) * 1'000'000'000 - drawn.attoseconds(k);
    ASSERT_TRUE(late >= 0 && late < 1'000'000'000) << k;
  });
}

// 12.5 ns at +137.25 ppm: after 10^12 ticks still on the tick that the period says.
TEST(Oscillator, NothingAccumulates) {
  const Drawn drawn{12'500, 137'250, 3};
  const std::int64_t k = 1'000'000'000'000;
  const Int128 exact = drawn.attoseconds(k);
  EXPECT_EQ(static_cast<Int128>(drawn.oscillator().time_of({k}).ns), (exact + 999'999'999) / 1'000'000'000);
}

TEST(Oscillator, AFastClockShowsMoreThanTrueTime) {
  const Oscillator fast(25'000, 1'000'000, 0), slow(25'000, -1'000'000, 0);
  const TrueTime second{1'000'000'000};
  EXPECT_NEAR(static_cast<double>(fast.local_time(fast.ticks_at(second)).ns), 1'001'000'000.0, 25.0);
  EXPECT_NEAR(static_cast<double>(slow.local_time(slow.ticks_at(second)).ns), 999'000'000.0, 25.0);
}

TEST(Oscillator, LocalTimeIsRoundedDown) {
  const Oscillator oscillator(12'500, 0, 0);
  EXPECT_EQ(oscillator.local_time({1}).ns, 12);
  EXPECT_EQ(oscillator.local_time({2}).ns, 25);
  EXPECT_EQ(oscillator.local_time({-1}).ns, -13);
}

}  // namespace
}  // namespace ttf::timebase
