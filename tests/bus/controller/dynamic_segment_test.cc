#include "bus/controller/dynamic_segment.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"

namespace ttf::bus::controller {
namespace {

schedules::model::GlobalParameters parameters() {
  schedules::model::GlobalParameters g;
  g.gNumberOfStaticSlots = 40;
  g.gdStaticSlot = 84;
  g.gdActionPointOffset = 7;
  g.gdMinislot = 5;
  g.gNumberOfMinislots = 250;
  g.gdMinislotActionPointOffset = 3;
  g.gdDynamicSlotIdlePhase = 1;
  g.gdNIT = 386;
  g.gOffsetCorrectionStart = 4900;
  return g;
}

timebase::CycleClock clock_at(std::int64_t start, int rate) {
  const schedules::model::GlobalParameters g = parameters();
  return timebase::CycleClock({g.gMacroPerCycle, g.gdMacrotick_ps, 200'000, g.gOffsetCorrectionStart},
                              Microticks{start}, rate);
}

// Counts as the specification does, minislot after minislot. A transmission that begins in m has its DTS end
// in last_of[m]; 0: none begins there.
std::vector<int> slots_one_by_one(const schedules::model::GlobalParameters& g, const std::vector<int>& last_of) {
  std::vector<int> slots(static_cast<std::size_t>(g.gNumberOfMinislots) + 1, 0);
  int slot = g.gNumberOfStaticSlots + 1;
  for (int m = 1; m <= g.gNumberOfMinislots; ++m, ++slot) {
    slots[static_cast<std::size_t>(m)] = slot > 2047 ? 0 : slot;
    const int last = last_of[static_cast<std::size_t>(m)];
    if (last == 0) continue;
    m = last + g.gdDynamicSlotIdlePhase;
  }
  return slots;
}

TEST(DynamicSlotCounter, CountsAMinislotForEverySlotInWhichNobodySends) {
  const DynamicSlotCounter counter(parameters());
  EXPECT_EQ(counter.slot_in(1), 41);
  EXPECT_EQ(counter.slot_in(250), 290);
  EXPECT_EQ(counter.minislot_of(41), 1);
  EXPECT_EQ(counter.minislot_of(290), 250);
  EXPECT_EQ(counter.minislot_of(40), 0);  // a static slot's turn is over
}

TEST(DynamicSlotCounter, ATransmissionTakesWholeMinislotsAndTheIdlePhase) {
  DynamicSlotCounter counter(parameters());
  counter.occupied(2, 5);  // the picture of the header: slot 42
  EXPECT_EQ(counter.slot_in(2), 0);
  EXPECT_EQ(counter.slot_in(6), 0);
  EXPECT_EQ(counter.slot_in(7), 43);
  EXPECT_EQ(counter.minislot_of(42), 0);
  EXPECT_EQ(counter.minislot_of(44), 8);
}

TEST(DynamicSlotCounter, StopsAtTheHighestFrameId) {
  schedules::model::GlobalParameters g = parameters();
  g.gNumberOfStaticSlots = 2040;  // more than a schedule may have; only the counter is checked
  const DynamicSlotCounter counter(g);
  EXPECT_EQ(counter.slot_in(7), 2047);
  EXPECT_EQ(counter.slot_in(8), 0);
}

TEST(DynamicSlotCounter, StartsAnewInEveryCycle) {
  DynamicSlotCounter counter(parameters());
  counter.occupied(1, 100);
  counter.start();
  EXPECT_EQ(counter.slot_in(1), 41);
}

TEST(DynamicSlotCounter, AgreesWithCountingMinislotByMinislot) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    RandomStream draw({seed, 0, Purpose::kTest, 0, 0});
    schedules::model::GlobalParameters g = parameters();
    g.gdDynamicSlotIdlePhase = static_cast<int>(draw.integer(0, 2));
    std::vector<int> last_of(static_cast<std::size_t>(g.gNumberOfMinislots) + 1, 0);
    DynamicSlotCounter counter(g);
    for (int m = 1 + static_cast<int>(draw.integer(0, 9)); m < g.gNumberOfMinislots;) {
      const int last = m + static_cast<int>(draw.integer(0, 20));
      last_of[static_cast<std::size_t>(m)] = last;
      const std::vector<int> expected = slots_one_by_one(g, last_of);
      ASSERT_EQ(counter.slot_in(m), expected[static_cast<std::size_t>(m)]) << "minislot " << m << ", seed " << seed;
      ASSERT_EQ(counter.minislot_of(expected[static_cast<std::size_t>(m)]), m);
      counter.occupied(m, last);
      m = last + 1 + g.gdDynamicSlotIdlePhase + static_cast<int>(draw.integer(0, 9));
    }
  }
}

TEST(DynamicSlotCounter, NoiseIntoATransmissionExtendsItsSlot) {
  DynamicSlotCounter counter(parameters());
  counter.occupied(2, 5);
  counter.occupied(4, 9);  // noise into it
  EXPECT_EQ(counter.slot_in(10), 0);
  EXPECT_EQ(counter.slot_in(11), 43);
}

TEST(MinislotGrid, BeginsAfterTheStaticSegmentAndTheDifferenceOfTheActionPoints) {
  const MinislotGrid grid(parameters());
  EXPECT_EQ(grid.start_of(1).value, 40 * 84 + 4);
  EXPECT_EQ(grid.action_point(1).value, 40 * 84 + 7);  // as deep as a static slot's
  EXPECT_EQ(grid.start_of(251).value, 5000 - 386);     // constraint 18: the NIT follows
}

TEST(MinislotGrid, FindsTheMinislotOfAnInstantOnAnyClock) {
  const MinislotGrid grid(parameters());
  for (const int rate : {-601, 0, 601}) {
    const timebase::CycleClock clock = clock_at(12'345, rate);
    for (int m = 1; m <= 250; ++m) {
      ASSERT_EQ(grid.minislot_at(clock, clock.start_of(grid.start_of(m))), m);
      ASSERT_EQ(grid.minislot_at(clock, clock.start_of(grid.start_of(m + 1)) - Microticks{1}), m);
    }
    EXPECT_EQ(grid.minislot_at(clock, clock.start_of(grid.start_of(1)) - Microticks{1}), 0);
    EXPECT_EQ(grid.minislot_at(clock, clock.start_of(grid.start_of(251))), 251);
  }
}

TEST(MinislotGrid, TheTrailingSequenceEndsAtTheFirstActionPointThatLeavesRoomForIt) {
  const MinislotGrid grid(parameters());
  const timebase::CycleClock clock = clock_at(0, 0);
  const Microticks bit{4};
  const Microticks at_ten = clock.start_of(grid.action_point(10));
  EXPECT_EQ(grid.dts_end(clock, at_ten - bit, bit), 10);
  EXPECT_EQ(grid.dts_end(clock, at_ten - bit + Microticks{1}, bit), 11);
  EXPECT_EQ(grid.dts_end(clock, clock.start_of(grid.action_point(250)), bit), 251);  // does not fit
}

}  // namespace
}  // namespace ttf::bus::controller
