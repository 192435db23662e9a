// How often frames and tasks may happen, against the definitions: cycles one by one.
#include "schedules/model/repetitions.h"

#include <gtest/gtest.h>

#include "schedules/model/cluster.h"

namespace ttf::schedules::model {
namespace {

GlobalParameters counting(int cycles) {
  GlobalParameters g;
  g.gCycleCountMax = cycles - 1;
  return g;
}

TEST(Repetitions, OfFramesAreThoseOfTheSpecification) {
  using List = std::vector<int>;
  EXPECT_EQ(frame_repetitions(counting(64)), (List{1, 2, 4, 8, 16, 32, 64}));  // 2.1 Rev. A
  EXPECT_EQ(frame_repetitions(counting(60)), (List{1, 2, 4, 5, 10, 20}));
  EXPECT_EQ(frame_repetitions(counting(50)), (List{1, 2, 5, 10, 50}));
  EXPECT_EQ(frame_repetitions(counting(40)), (List{1, 2, 4, 5, 8, 10, 20, 40}));
  EXPECT_EQ(frame_repetitions(counting(8)), (List{1, 2, 4, 8}));
  EXPECT_EQ(repetitions(counting(64)), frame_repetitions(counting(64)));
  EXPECT_EQ(repetitions(counting(12)), (List{1, 2, 3, 4, 6, 12}));
}

// After a round all is as before, whatever the repetition.
TEST(Repetitions, TheScheduleRepeatsAfterARound) {
  for (int cycles = 8; cycles <= kMostCycles; cycles += 2) {
    const GlobalParameters g = counting(cycles);
    EXPECT_EQ(first_analysed(g) % cycles, 0);
    EXPECT_GE(first_analysed(g), 4 * kMostCycles);
    for (const int repetition : repetitions(g))
      for (std::int64_t cycle = 0; cycle < cycles; ++cycle)
        for (const std::int64_t round : {1, 7}) {
          const CycleInstant at{static_cast<int>(cycle) % repetition, repetition, {}};
          EXPECT_EQ(counter_in(g, cycle + round * cycles), cycle);
          EXPECT_EQ(counter_in(g, cycle - round * cycles), cycle);
          EXPECT_TRUE(in_cycle(at, cycle + round * cycles));
        }
  }
}

TEST(Repetitions, FramesShareACycleIfSomeCycleHasBoth) {
  const GlobalParameters g = counting(60);
  for (const int first : repetitions(g))
    for (const int second : repetitions(g))
      for (int base = 0; base < first; ++base)
        for (int other = 0; other < second; ++other) {
          FrameSlot a, b;
          a.base_cycle = base, a.repetition = first;
          b.base_cycle = other, b.repetition = second;
          bool both = false;
          for (int cycle = 0; cycle < 60; ++cycle) both = both || (in_cycle(a, cycle) && in_cycle(b, cycle));
          EXPECT_EQ(share_a_cycle(a, b), both) << base << " of " << first << ", " << other << " of " << second;
        }
}

}  // namespace
}  // namespace ttf::schedules::model
