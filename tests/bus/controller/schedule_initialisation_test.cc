#include "bus/controller/schedule_initialisation.h"

#include <gtest/gtest.h>

#include "timebase/cycle_clock.h"

namespace ttf::bus::controller {
namespace {

using schedules::model::Channel;

class ScheduleInitialisationTest : public ::testing::Test {
 protected:
  ScheduleInitialisationTest() {
    flexray.gdStaticSlot = 84;
    flexray.gNumberOfStaticSlots = 40;
    node.pMicroPerCycle = 200'000;
    node.pRateCorrectionOut = 601;
    node.pDelayCompensationA = 50;
    node.pDelayCompensationB = 30;
  }
  // The arrival of a frame of `slot` in `cycle` at a node whose cycles last `length` microticks from `origin`
  // on.
  static Microticks arrival(int slot, int cycle, std::int64_t origin, std::int64_t length, int delay) {
    const std::int64_t into = ((slot - 1) * 84 + 7) * length;
    return Microticks{origin + cycle * length + (into + 4999) / 5000 + delay};
  }
  StartupFrame frame(int slot, int cycle, Channel channel = Channel::kA, std::int64_t length = 200'000) const {
    return {channel, slot, cycle, arrival(slot, cycle, 7'000, length, channel == Channel::kA ? 50 : 30)};
  }
  schedules::model::GlobalParameters flexray;
  schedules::model::NodeParameters node;
};

TEST_F(ScheduleInitialisationTest, APairGivesCycleStartAndRate) {
  for (const int rate : {-601, -13, 0, 1, 601})
    for (const int slot : {1, 17, 40})
      for (const Channel channel : {Channel::kA, Channel::kB}) {
        ScheduleInitialisation initialisation(flexray, node);
        const std::int64_t length = 200'000 + rate;
        EXPECT_FALSE(initialisation.receive(frame(slot, 4, channel, length)));
        const auto schedule = initialisation.receive(frame(slot, 5, channel, length));
        ASSERT_TRUE(schedule) << "rate " << rate << " slot " << slot;
        EXPECT_EQ(schedule->frame_id, slot);
        EXPECT_EQ(schedule->cycle, 5);
        EXPECT_EQ(schedule->rate, rate);
        EXPECT_EQ(schedule->cycle_start.value, 7'000 + 5 * length);
      }
}

TEST_F(ScheduleInitialisationTest, TheClockSetGoingExpectsTheNextFrameWhereItComes) {
  ScheduleInitialisation initialisation(flexray, node);
  initialisation.receive(frame(3, 62, Channel::kA, 199'937));
  const auto schedule = initialisation.receive(frame(3, 63, Channel::kA, 199'937));
  ASSERT_TRUE(schedule);
  timebase::CycleClock clock({5000, 1'000'000, 200'000, 4900}, schedule->cycle_start, schedule->rate, schedule->cycle);
  EXPECT_EQ(clock.cycle(), 63);
  clock.next_cycle(schedule->rate);
  EXPECT_EQ(clock.cycle(), 64);
  EXPECT_EQ(clock.start_of(Macroticks{2 * 84 + 7}) + Microticks{50}, frame(3, 64, Channel::kA, 199'937).start);
}

TEST_F(ScheduleInitialisationTest, OddFramesAloneGiveNothing) {
  ScheduleInitialisation initialisation(flexray, node);
  for (const int cycle : {1, 3, 5}) EXPECT_FALSE(initialisation.receive(frame(1, cycle)));
}

TEST_F(ScheduleInitialisationTest, ThePartnerIsTheSameNodesFrameOfTheNextCycle) {
  ScheduleInitialisation initialisation(flexray, node);
  initialisation.receive(frame(1, 4));
  initialisation.receive(frame(2, 4));  // the first of the cycle counts
  EXPECT_FALSE(initialisation.receive(frame(2, 5)));
  EXPECT_FALSE(initialisation.receive(frame(1, 7)));  // a double cycle late
  EXPECT_FALSE(initialisation.receive(frame(1, 5 + 4)));
  initialisation.receive(frame(1, 10));
  EXPECT_TRUE(initialisation.receive(frame(1, 11)));
}

TEST_F(ScheduleInitialisationTest, ANodeThatFallsSilentMakesRoomForAnother) {
  ScheduleInitialisation initialisation(flexray, node);
  initialisation.receive(frame(1, 4));
  EXPECT_FALSE(initialisation.receive(frame(2, 5)));
  initialisation.receive(frame(2, 6));
  const auto schedule = initialisation.receive(frame(2, 7));
  ASSERT_TRUE(schedule);
  EXPECT_EQ(schedule->frame_id, 2);
}

TEST_F(ScheduleInitialisationTest, AClockTooFarOffIsRefusedAndListeningBeginsAnew) {
  ScheduleInitialisation initialisation(flexray, node);
  for (const int rate : {-602, 602}) {
    initialisation.receive(frame(1, 4, Channel::kA, 200'000 + rate));
    EXPECT_FALSE(initialisation.receive(frame(1, 5, Channel::kA, 200'000 + rate)));
  }
}

TEST_F(ScheduleInitialisationTest, TheChannelsAreListenedToIndependently) {
  ScheduleInitialisation initialisation(flexray, node);
  initialisation.receive(frame(1, 4, Channel::kA));
  EXPECT_FALSE(initialisation.receive(frame(1, 5, Channel::kB)));  // B has received no even frame
  initialisation.receive(frame(5, 6, Channel::kB));
  EXPECT_TRUE(initialisation.receive(frame(5, 7, Channel::kB)));
}

TEST_F(ScheduleInitialisationTest, ResetForgetsTheEvenFrame) {
  ScheduleInitialisation initialisation(flexray, node);
  initialisation.receive(frame(1, 4));
  initialisation.reset();
  EXPECT_FALSE(initialisation.receive(frame(1, 5)));
}

}  // namespace
}  // namespace ttf::bus::controller
