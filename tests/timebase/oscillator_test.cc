#include "timebase/oscillator.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/int128.h"
#include "core/random.h"

namespace ttf::timebase {
namespace {

struct Drawn {
  std::int64_t nominal_ps, drift_ppb, phase_ps;
  Oscillator oscillator() const { return {nominal_ps, drift_ppb, phase_ps}; }
  // The law's tick k, computed here: phase + k * (nominal / (1 + drift) rounded to an attosecond).
  Int128 attoseconds(std::int64_t k) const {
    const Int128 top = static_cast<Int128>(nominal_ps) * 1'000'000 * 1'000'000'000;
    const Int128 bottom = 1'000'000'000 + drift_ppb;
    const Int128 period = (2 * top + bottom) / (2 * bottom);
    return period * k + static_cast<Int128>(phase_ps) * 1'000'000;
  }
};

// Periods from the shortest that stay above 1 ns to 1 us, drifts over the whole range, phases anywhere.
Drawn draw(RandomStream& stream) {
  constexpr std::int64_t kUsual[] = {12'500, 25'000, 50'000};
  const std::int64_t nominal =
      stream.integer(0, 1) == 0 ? kUsual[stream.integer(0, 2)] : stream.integer(1'112, 1'000'000);
  // Half of them as the specification has them, half as faults make them.
  const std::int64_t most = stream.integer(0, 1) == 0 ? 1'500'000 : Oscillator::kMaxDrift_ppb;
  return {nominal, stream.integer(-most, most), stream.integer(0, nominal - 1)};
}

template <class Law> void for_drawn_ticks(std::uint16_t entity, Law law) {
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

// With periods and phases of whole nanoseconds, ticks are neither late nor early, where rounded estimates are
// off by one. Late ticks, whose rounding errors have added up, are tested, too.
TEST(OscillatorLaws, L1AndL3_HoldAtTicksOnTheNanosecondAndLongAfterTheStart) {
  RandomStream stream({1, 0, Purpose::kTest, 6, 0});
  for (int clock = 0; clock < 300; ++clock) {
    Drawn drawn = draw(stream);
    if (clock % 3 < 2) drawn = {1000 * stream.integer(2, 50), 0, 1000 * stream.integer(0, 1)};
    const Oscillator oscillator = drawn.oscillator();
    for (int i = 0; i < 100; ++i) {
      const std::int64_t k = stream.integer(0, stream.integer(0, 1) == 0 ? 100 : std::int64_t{1} << 52);
      const TrueTime at = oscillator.time_of({k});
      const Int128 late = static_cast<Int128>(at.ns) * 1'000'000'000 - drawn.attoseconds(k);
      ASSERT_TRUE(late >= 0 && late < 1'000'000'000) << k;
      ASSERT_EQ(oscillator.ticks_at(at).value, k);
      ASSERT_EQ(oscillator.ticks_at(at - Duration{1}).value, k - 1);
    }
  }
}

// After changes of drift at drawn instants, some at one instant and some within one tick.
template <class Law> void for_drawn_changes(std::uint16_t entity, Law law) {
  RandomStream stream({1, 0, Purpose::kTest, entity, 0});
  for (int clock = 0; clock < 300; ++clock) {
    const Drawn drawn = draw(stream);
    Oscillator oscillator = drawn.oscillator();
    TrueTime at{stream.integer(-1'000'000, 1'000'000'000'000)};
    TrueTime since = at - Duration{1'000'000'000};  // nothing has changed from here to `at`
    for (int change = 0; change < 8; ++change) {
      const Oscillator before = oscillator;
      oscillator.change_drift(at, stream.integer(-Oscillator::kMaxDrift_ppb, Oscillator::kMaxDrift_ppb));
      law(before, oscillator, since, at, stream);
      const Duration pause{stream.integer(0, std::int64_t{1} << stream.integer(0, 40))};
      if (pause.ns > 0) since = at;
      at = at + pause;
    }
  }
}

TEST(OscillatorLaws, L1ToL3_HoldAcrossChangesOfDrift) {
  for_drawn_changes(4, [](const Oscillator&, const Oscillator& oscillator, TrueTime, TrueTime at,
                          RandomStream& stream) {
    const Microticks counted = oscillator.ticks_at(at);
    for (int i = 0; i < 50; ++i) {
      const std::int64_t reach = i < 10 ? 3 : std::int64_t{1} << stream.integer(0, 30);
      const Microticks k = counted + Microticks{stream.integer(-reach, reach)};
      const TrueTime happens = oscillator.time_of(k);
      ASSERT_EQ(oscillator.ticks_at(happens), k);
      ASSERT_EQ(oscillator.ticks_at(happens - Duration{1}), k - Microticks{1});  // so it is the first nanosecond (L3)
      ASSERT_LT(happens, oscillator.time_of(k + Microticks{1}));
    }
  });
}

TEST(OscillatorLaws, L4_TicksAlreadyCountedStay) {
  for_drawn_changes(
      5, [](const Oscillator& before, const Oscillator& after, TrueTime since, TrueTime at, RandomStream& stream) {
        const Microticks counted = before.ticks_at(at);
        ASSERT_EQ(after.ticks_at(at), counted);
        // As far back as the change before, which is remembered.
        for (int i = 0; i < 20; ++i) {
          const TrueTime past = at - Duration{stream.integer(0, std::min((at - since).ns, std::int64_t{1} << i))};
          const Microticks k = before.ticks_at(past);
          ASSERT_EQ(after.ticks_at(past), k);
          if (before.time_of(k) < since) continue;
          ASSERT_EQ(after.time_of(k), before.time_of(k));
        }
      });
}

// A tick half over when the clock becomes a tenth slower takes the other half of a longer period.
TEST(Oscillator, TheTickUnderWayIsStretched) {
  Oscillator oscillator(25'000, 0, 0);
  oscillator.change_drift(TrueTime{1'012}, -100'000'000);  // 13 ns of tick 41 are left: 13 / 0.9 = 14.4 ns
  EXPECT_EQ(oscillator.ticks_at(TrueTime{1'012}).value, 40);
  EXPECT_EQ(oscillator.time_of({40}).ns, 1'000);
  EXPECT_EQ(oscillator.time_of({41}).ns, 1'027);      // 1012 + 14.4
  EXPECT_EQ(oscillator.time_of({42}).ns, 1'055);      // + 27.8
  EXPECT_EQ(oscillator.time_of({1'041}).ns, 28'805);  // 41 is at 1026.44, a thousand later at 28804.22
  EXPECT_EQ(oscillator.local_time({41}).ns, 1'025);
}

// 12.5 ns at +137.25 ppm: after 10^12 ticks still on the period's tick.
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
