#include "timebase/cycle_clock.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/int128.h"
#include "core/random.h"

namespace ttf::timebase {
namespace {

// 25 ns microticks; 5000 macroticks of 1 us, and 3636 of 1.375 us.
constexpr CycleGeometry kEven{5000, 1'000'000, 200'000, 4900};
constexpr CycleGeometry kOdd{3636, 1'375'000, 199'980, 3632};

// Clocks of drawn rates, advanced some cycles with drawn corrections; the law sees each cycle.
template <class Law> void for_drawn_cycles(std::uint16_t entity, Law law) {
  RandomStream stream({2, 0, Purpose::kTest, entity, 0});
  for (int run = 0; run < 40; ++run) {
    const CycleGeometry& geometry = run % 2 == 0 ? kEven : kOdd;
    const int room = run % 2 == 0 ? 400 : 100;
    const auto rate = [&] { return static_cast<int>(stream.integer(-601, 601)); };
    CycleClock clock(geometry, {stream.integer(0, 1'000'000)}, rate());
    for (int cycle = 0; cycle < 8; ++cycle) {
      if (cycle % 2 == 1) clock.set_offset_correction(static_cast<int>(stream.integer(-room, room)));
      law(geometry, clock, stream);
      clock.next_cycle(rate());
    }
  }
}

TEST(CycleClock, ACycleIsItsMicroticksPlusCorrections) {
  CycleClock clock(kEven, {1000}, 7);
  EXPECT_EQ(clock.cycle_end().value, 1000 + 200'007);
  clock.set_offset_correction(-30);
  EXPECT_EQ(clock.cycle_end().value, 1000 + 200'007 - 30);
  clock.next_cycle(-2);
  EXPECT_EQ(clock.cycle(), 1);
  EXPECT_EQ(clock.cycle_start().value, 1000 + 200'007 - 30);
  EXPECT_EQ(clock.offset_correction(), 0);  // used up
  EXPECT_EQ(clock.rate_correction(), -2);
  EXPECT_EQ(clock.cycle_end().value, 1000 + 200'007 - 30 + 199'998);
}

TEST(CycleClock, MacroticksSumExactlyOverCycles) {
  RandomStream stream({2, 0, Purpose::kTest, 1, 0});
  CycleClock clock(kOdd, {0}, 13);
  std::int64_t expected = 0;
  for (int cycle = 0; cycle < 1000; ++cycle) {
    EXPECT_EQ(clock.start_of({0}).value, expected);
    const int rate = clock.rate_correction();
    const int offset = cycle % 2 == 1 ? static_cast<int>(stream.integer(-100, 100)) : 0;
    clock.set_offset_correction(offset);
    expected += kOdd.micro_per_cycle + rate + offset;
    EXPECT_EQ(clock.start_of({kOdd.macro_per_cycle}).value, expected);
    clock.next_cycle(static_cast<int>(stream.integer(-601, 601)));
  }
}

// Every macrotick starts at the first microtick at or after its exact share, before the correction phase and
// in it.
TEST(CycleClock, MacroticksAreSpreadEvenly) {
  for_drawn_cycles(2, [](const CycleGeometry& g, const CycleClock& clock, RandomStream&) {
    const std::int64_t length = g.micro_per_cycle + clock.rate_correction();
    const std::int64_t corrected = clock.start_of({g.offset_correction_start}).value - clock.cycle_start().value;
    const std::int64_t rest = length + clock.offset_correction() - corrected;
    for (int m = 0; m <= g.macro_per_cycle; ++m) {
      const std::int64_t start = clock.start_of({m}).value - clock.cycle_start().value;
      const bool phase = m > g.offset_correction_start;
      const std::int64_t numerator = phase ? (m - g.offset_correction_start) * rest : m * length;
      const std::int64_t denominator = phase ? g.macro_per_cycle - g.offset_correction_start : g.macro_per_cycle;
      const std::int64_t share = start - (phase ? corrected : 0);
      ASSERT_GE(share * denominator, numerator) << m;
      ASSERT_LT((share - 1) * denominator, numerator) << m;
    }
  });
}

TEST(CycleClock, OffsetCorrectionTouchesTheCorrectionPhaseOnly) {
  CycleClock plain(kEven, {0}, 11), corrected(kEven, {0}, 11);
  corrected.set_offset_correction(400);
  for (int m = 0; m <= kEven.offset_correction_start; ++m) EXPECT_EQ(plain.start_of({m}), corrected.start_of({m}));
  EXPECT_EQ(corrected.cycle_end() - plain.cycle_end(), Microticks{400});
}

// 100 of 5000 macroticks of (200000 - 601) microticks: 3987, of which one must be left.
TEST(CycleClock, ACorrectionMustLeaveSomethingOfItsPhase) {
  CycleClock clock(kEven, {0}, -601);
  clock.set_offset_correction(-3986);
  EXPECT_EQ(clock.start_of({5000}).value - clock.start_of({4900}).value, 1);
  clock.set_offset_correction(-3987);
  EXPECT_EQ(clock.start_of({4900}).value, 195'412);  // before the phase nothing changes
  EXPECT_DEATH(clock.start_of({4901}), "a correction by -3987 leaves 0 of 199399 microticks behind the first 195412");
  EXPECT_DEATH(clock.global_time({195'413}), "leaves 0 of 199399");
}

TEST(CycleClockDeathTest, AGeometryThatNoCycleHasIsOurBug) {
  const auto with = [](int macroticks, int microticks, int correction_start) {
    return CycleClock({macroticks, 1'000'000, microticks, correction_start}, {0}, 0);
  };
  EXPECT_DEATH(with(0, 200'000, 1), "0 macroticks, 200000 microticks");
  EXPECT_DEATH(with(5000, 10'000, 4900), "5000 macroticks, 10000 microticks");
  EXPECT_DEATH(with(5000, 200'000, 0), "offset correction starts at 0");
  EXPECT_DEATH(with(5000, 200'000, 5000), "offset correction starts at 5000");
}

TEST(CycleClock, GlobalTimeIsMonotoneAcrossTheCyclesCorners) {
  for_drawn_cycles(3, [](const CycleGeometry& g, const CycleClock& clock, RandomStream&) {
    for (const std::int64_t corner : {clock.start_of({1}).value, clock.start_of({g.offset_correction_start}).value,
                                      clock.cycle_end().value - 200}) {
      GlobalTime before = clock.global_time({corner - 20});
      for (std::int64_t t = corner - 19; t < corner + 200 && t < clock.cycle_end().value; ++t) {
        const GlobalTime now = clock.global_time({t});
        ASSERT_GE(now, before);
        before = now;
      }
    }
    CycleClock next = clock;
    const GlobalTime last = clock.global_time(clock.cycle_end() - Microticks{1});
    next.next_cycle(0);
    ASSERT_GT(next.global_time(next.cycle_start()), last);
    ASSERT_EQ(next.global_time(next.cycle_start()).ns, next.cycle() * g.macro_per_cycle * (g.macrotick_ps / 1000));
  });
}

// At the start of macrotick m the clock shows m macroticks; one microtick earlier it does not yet.
TEST(CycleClock, GlobalTimeAgreesWithMacrotickStarts) {
  for_drawn_cycles(4, [](const CycleGeometry& g, const CycleClock& clock, RandomStream& stream) {
    for (int i = 0; i < 50; ++i) {
      const std::int64_t m = stream.integer(1, g.macro_per_cycle - 1);
      const GlobalTime shows{(clock.cycle() * g.macro_per_cycle + m) * (g.macrotick_ps / 1000)};
      ASSERT_GE(clock.global_time(clock.start_of({m})), shows);
      ASSERT_LT(clock.global_time(clock.start_of({m}) - Microticks{1}), shows);
      ASSERT_EQ(clock.when(shows), clock.start_of({m}));
    }
  });
}

TEST(CycleClock, WhenIsTheFirstMicrotickAtOrAfter) {
  for_drawn_cycles(5, [](const CycleGeometry& g, const CycleClock& clock, RandomStream& stream) {
    const std::int64_t begin = clock.cycle() * g.macro_per_cycle * (g.macrotick_ps / 1000);
    const std::int64_t length = g.macro_per_cycle * (g.macrotick_ps / 1000);
    for (int i = 0; i < 50; ++i) {
      const GlobalTime time{begin + stream.integer(1, length - 1)};
      const Microticks at = clock.when(time);
      ASSERT_LE(at, clock.cycle_end());
      ASSERT_LT(clock.global_time(at - Microticks{1}), time);
      ASSERT_TRUE(at == clock.cycle_end() || clock.global_time(at) >= time);
      const Microticks t{stream.integer(clock.cycle_start().value, clock.cycle_end().value - 1)};
      ASSERT_LE(clock.when(clock.global_time(t)), t);
    }
    ASSERT_EQ(clock.when(GlobalTime{begin}), clock.cycle_start());
    ASSERT_EQ(clock.when(GlobalTime{begin + length}), clock.cycle_end());
    ASSERT_EQ(clock.when(GlobalTime{begin + 10 * length}), clock.cycle_end());
  });
}

Int128 floor_of(Int128 a, Int128 b) { return a / b - (a % b < 0 ? 1 : 0); }

// The law's value at microtick `into` of the cycle, rounded down to the picosecond and then to the
// nanosecond.
std::int64_t global_ns(const CycleGeometry& g, const CycleClock& clock, std::int64_t into) {
  const Int128 length = g.micro_per_cycle + clock.rate_correction();
  const Int128 before = -floor_of(-length * g.offset_correction_start, g.macro_per_cycle);
  const Int128 at_correction = static_cast<Int128>(g.macrotick_ps) * g.offset_correction_start;
  const Int128 cycle = static_cast<Int128>(g.macrotick_ps) * g.macro_per_cycle;
  Int128 elapsed = std::min(floor_of(cycle * into, length), at_correction);
  if (into > before)
    elapsed = at_correction +
              floor_of((cycle - at_correction) * (into - before), length + clock.offset_correction() - before);
  return static_cast<std::int64_t>(floor_of(cycle * clock.cycle() + elapsed, 1000));
}

// From the first cycles to those whose picoseconds fill 64 bits, also with macroticks of fractional
// nanoseconds. Tests the cycle's corners, where roundings show, drawn instants, and instants behind its end.
TEST(CycleClock, GlobalTimeIsTheLawsToTheNanosecond) {
  RandomStream stream({2, 0, Purpose::kTest, 6, 0});
  for (int run = 0; run < 400; ++run) {
    const int macroticks = static_cast<int>(stream.integer(10, 16'000));
    const CycleGeometry g{macroticks, stream.integer(999'000, 6'000'001),
                          static_cast<int>(stream.integer(20, 240) * macroticks + stream.integer(1, 9)),
                          static_cast<int>(stream.integer(1, macroticks - 1))};
    const std::int64_t full = (std::int64_t{1} << 62) / (g.macrotick_ps * macroticks);
    const std::int64_t firsts[] = {0, stream.integer(0, 63), stream.integer(0, full), full - 3, full + 10, -2};
    const int most = g.micro_per_cycle / 700;
    const auto rate = [&] { return static_cast<int>(stream.integer(-most, most)); };
    CycleClock clock(g, {stream.integer(-1'000'000, std::int64_t{1} << 50)}, rate(), firsts[run % 6]);
    for (int cycle = 0; cycle < 6; ++cycle) {
      const auto check = [&](std::int64_t into) {
        if (into < 0 && cycle > 0) return;
        ASSERT_EQ(clock.global_time(clock.cycle_start() + Microticks{into}).ns, global_ns(g, clock, into))
            << "run " << run << " cycle " << clock.cycle() << " microtick " << into;
      };
      const std::int64_t corrected = (clock.start_of({g.offset_correction_start}) - clock.cycle_start()).value;
      const std::int64_t room = (clock.cycle_end() - clock.cycle_start()).value - corrected - 1;
      if (cycle % 2 == 1)
        clock.set_offset_correction(static_cast<int>(stream.integer(-std::min<std::int64_t>(room, 400), 400)));
      const std::int64_t end = (clock.cycle_end() - clock.cycle_start()).value;
      for (std::int64_t around = -3; around <= 3; ++around)
        for (const std::int64_t corner : {std::int64_t{0}, corrected, end}) check(corner + around);
      for (int i = 0; i < 40; ++i) check(stream.integer(-end, 3 * end));
      check(std::int64_t{1} << 45);
      clock.next_cycle(stream.integer(0, 1) == 0 ? clock.rate_correction() : rate());
    }
  }
}

TEST(CycleClock, GlobalTimeIsRoundedDownBeforeTheFirstCycleToo) {
  // 200'001 microticks make 5 ms: one is a little less than 25 ns.
  const CycleClock clock(kEven, {1000}, 1);
  for (std::int64_t ticks = 1; ticks <= 1000; ++ticks) {
    const Int128 exact_ps = static_cast<Int128>(ticks) * 5'000'000'000;  // times 1 / 200'001
    const std::int64_t down =
        -static_cast<std::int64_t>((exact_ps + Int128{200'001} * 1000 - 1) / (Int128{200'001} * 1000));
    ASSERT_EQ(clock.global_time({1000 - ticks}).ns, down) << ticks;
  }
  EXPECT_EQ(clock.global_time({1000}).ns, 0);
}

}  // namespace
}  // namespace ttf::timebase
