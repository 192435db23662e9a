// True states between the rows of a recording, by hand.
#include "recording/replay/truth.h"

#include <gtest/gtest.h>

#include "tests/recording/replay/replay_rows.h"

namespace ttf::recording::replay {
namespace {

recording::rows::ObservationRow true_row(std::int64_t time_ms, const std::string& object, double x,
                                         std::optional<std::array<double, 2>> velocity = std::nullopt) {
  recording::rows::ObservationRow row = position_row("lidar", time_ms, time_ms, 0.0, 0.0);
  row.truth = {object, x, 1.0, velocity};
  return row;
}

GlobalTime at_ms(std::int64_t at) { return GlobalTime{at * 1'000'000}; }

TEST(RecordedTruthPath, RowsWithoutTruthHaveNone) {
  EXPECT_TRUE(Truth({position_row("lidar", 0, 0, 1.0, 2.0)}).empty());
}

//   time [ms]   0     100         2000   2100
//   b           10    12          50     54
//   a                 at 100 only, 7
TEST(RecordedTruthPath, IsInterpolatedWithinItsLife) {
  const Truth truth({true_row(2000, "b", 50), true_row(0, "b", 10), true_row(100, "b", 12), true_row(100, "b", 99),
                     true_row(100, "a", 7), true_row(2100, "b", 54)});
  ASSERT_FALSE(truth.empty());
  EXPECT_TRUE(truth.at(at_ms(-1)).empty());
  EXPECT_TRUE(truth.at(at_ms(2101)).empty());
  EXPECT_TRUE(truth.at(at_ms(1000)).empty()) << "a gap of more than a second";

  const auto first = truth.at(at_ms(0)), middle = truth.at(at_ms(25)), both = truth.at(at_ms(100)),
             last = truth.at(at_ms(2050));
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].is.name, 1u) << "the second name";
  EXPECT_EQ(first[0].is.at.x, 10.0);
  ASSERT_EQ(middle.size(), 1u);
  EXPECT_NEAR(middle[0].is.at.x, 10.5, 1e-12);
  EXPECT_NEAR(middle[0].vx, 20.0, 1e-12);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].is.name, 0u);
  EXPECT_EQ(both[0].is.at.x, 7.0);
  EXPECT_NEAR(both[1].is.at.x, 12.0, 1e-12) << "the first row of an instant counts";
  ASSERT_EQ(last.size(), 1u);
  EXPECT_NEAR(last[0].vx, 40.0, 1e-9);
}

TEST(RecordedTruthPath, AGivenVelocityIsInterpolated) {
  const Truth truth({true_row(0, "", 0, std::array{10.0, 1.0}), true_row(100, "", 1.2, std::array{14.0, 3.0})});
  const auto objects = truth.at(at_ms(50));
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_NEAR(objects[0].is.at.x, 0.6, 1e-12);
  EXPECT_NEAR(objects[0].vx, 12.0, 1e-12);
  EXPECT_NEAR(objects[0].vy, 2.0, 1e-12);
}

}  // namespace
}  // namespace ttf::recording::replay
