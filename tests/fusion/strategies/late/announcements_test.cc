// The announced scheduled instants, and the lists that belong to them.
#include "fusion/strategies/late/announcements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/fusion/strategies/late/late_scenes.h"

namespace ttf::fusion::strategies::late {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

OwnedList list(std::uint8_t sensor, std::uint32_t sequence, std::int64_t us) {
  return list_of(sensor, sequence, GlobalTime{us * 1000});
}
oosm::Stamp instant(std::uint8_t sensor, std::int64_t ms) { return {at_ms(ms), {SensorId{sensor}, 0}}; }
std::vector<oosm::Stamp> passed(Announcements& announcements, const OwnedList& list) {
  const auto due = announcements.pass(list.view());
  return {due.begin(), due.end()};
}

//   sensor 0   0       40        80
//   sensor 1       20       60
TEST(Announcements, AreOfTheListsThatTimePasses) {
  Announcements announcements(in_turn());
  EXPECT_THAT(passed(announcements, list(0, 7, 3)), IsEmpty()) << "nothing is before the first";
  EXPECT_THAT(passed(announcements, list(0, 8, 40'002)), ElementsAre(instant(1, 20)));
  EXPECT_THAT(passed(announcements, list(0, 9, 79'998)), ElementsAre(instant(1, 60))) << "80 ms is its own";
  EXPECT_THAT(passed(announcements, list(0, 9, 79'999)), IsEmpty()) << "each once";
}

TEST(Announcements, MatchTheListByItsInstant) {
  Announcements announcements(in_turn());
  const auto when = [&](const OwnedList& list) { return announcements.when(list.view()); };
  EXPECT_EQ(when(list(1, 5, 20'004)).stamp, oosm::Stamp(GlobalTime{20'004'000}, {SensorId{1}, 5})) << "not announced";
  announcements.pass(list(0, 0, 0).view());
  announcements.pass(list(0, 1, 40'000).view());
  for (const std::int64_t off : {-10'000, -4, 0, 4, 10'000}) {
    const When late = when(list(1, 5, 20'000 + off));
    EXPECT_EQ(late.stamp, instant(1, 20));
    EXPECT_EQ(late.after, Duration::microseconds(off));
  }
  EXPECT_EQ(when(list(1, 5, 30'001)).stamp, oosm::Stamp(GlobalTime{30'001'000}, {SensorId{1}, 5})) << "fits none";
  EXPECT_EQ(when(list(1, 6, 60'001)).stamp, oosm::Stamp(GlobalTime{60'001'000}, {SensorId{1}, 6})) << "still to come";
  EXPECT_EQ(when(list(2, 0, 20'000)).stamp, oosm::Stamp(GlobalTime{20'000'000}, {SensorId{2}, 0})) << "free";
  EXPECT_EQ(when(list(2, 0, 20'000)).after, Duration{});
}

TEST(Announcements, AfterASilenceAreOfTheNewest) {
  Announcements announcements(in_turn());
  announcements.pass(list(0, 0, 0).view());
  const std::vector<oosm::Stamp> due = passed(announcements, list(0, 50, 2'000'000));
  ASSERT_EQ(due.size(), 15u) << "eight of each, but for the list itself";
  EXPECT_EQ(due.front(), instant(0, 1720));
  EXPECT_EQ(due[6], instant(0, 1960));
  EXPECT_EQ(due[7], instant(1, 1700));
  EXPECT_EQ(due.back(), instant(1, 1980));
}

TEST(Announcements, BeginWithTheSchedule) {
  Announcements announcements(std::vector{scheduled(0, 10, 0, 40), scheduled(1, 10, 100, 40)});
  announcements.pass(list(0, 0, 0).view());
  EXPECT_THAT(passed(announcements, list(0, 1, 40'000)), IsEmpty());
  EXPECT_THAT(passed(announcements, list(0, 3, 120'000)), ElementsAre(instant(0, 80), instant(1, 100)));
}

}  // namespace
}  // namespace ttf::fusion::strategies::late
