#include "sensors/radar/returns.h"

#include <gtest/gtest.h>

#include <vector>

namespace ttf::sensors::radar {
namespace {

std::vector<RadarObject> joined(const std::vector<Return>& returns, const RadarPreprocessingConfig& config = {}) {
  ReturnJoiner joiner(config, returns.size());
  std::vector<RadarObject> objects;
  joiner.join(returns, objects);
  return objects;
}

TEST(RadarReturns, OfOneObjectAreItsMean) {
  const auto objects = joined({{50.0, 0.01, 3.0}, {51.2, 0.02, 3.1}, {49.9, 0.03, 2.9}});
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_NEAR(objects[0].range, 50.3667, 1e-4);
  EXPECT_NEAR(objects[0].bearing, 0.02, 1e-12);
  EXPECT_NEAR(objects[0].range_rate, 3.0, 1e-12);
  EXPECT_EQ(objects[0].returns, 3);
}

TEST(RadarReturns, AChainIsOneObject) {
  EXPECT_EQ(joined({{50.0, 0.0, 0.0}, {54.5, 0.0, 0.0}, {59.0, 0.0, 0.0}}).size(), 1U);
}

TEST(RadarReturns, BeyondEachGateAreOfOthers) {
  EXPECT_EQ(joined({{50.0, 0.0, 0.0}, {55.1, 0.0, 0.0}}).size(), 2U);
  EXPECT_EQ(joined({{50.0, 0.0, 0.0}, {50.0, 0.0, 1.1}}).size(), 2U);
  // Across, the azimuths' errors count, too.
  EXPECT_EQ(joined({{50.0, 0.0, 0.0}, {50.0, 0.06, 0.0}}).size(), 1U);
  EXPECT_EQ(joined({{50.0, 0.0, 0.0}, {50.0, 0.07, 0.0}}).size(), 2U);
}

// At 10 m, 0.25 rad are 2.5 m. A car there that the vehicle passes at 8 m/s has range rates 2 m/s apart.
TEST(RadarReturns, OfAnObjectThatIsPassedDifferInRangeRate) {
  const std::vector<Return> passed = {{10.0, -1.4, -1.0}, {10.0, -1.65, 1.0}};
  EXPECT_EQ(joined(passed).size(), 2U);
  RadarPreprocessingConfig config;
  config.transverse_speed_mps = 8.0;
  EXPECT_EQ(joined(passed, config).size(), 1U);
  EXPECT_EQ(joined({{10.0, -1.4, -1.0}, {10.0, -1.4, 1.0}}, config).size(), 2U) << "in one direction";
}

TEST(RadarReturns, AFoldMayLieBetweenRangeRates) {
  RadarPreprocessingConfig config;
  config.rate_span_mps = 40.0;
  const auto objects = joined({{50.0, 0.0, 19.9}, {50.5, 0.0, -19.7}}, config);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_NEAR(objects[0].range_rate, -19.9, 1e-9);
}

TEST(RadarReturns, TheNearestIsFirst) {
  const auto objects = joined({{90.0, 0.0, 0.0}, {20.0, 0.0, 0.0}, {50.0, 0.0, 0.0}});
  ASSERT_EQ(objects.size(), 3U);
  EXPECT_LT(objects[0].range, objects[1].range);
  EXPECT_LT(objects[1].range, objects[2].range);
}

TEST(RadarReturns, MoreOfThemErrLess) {
  const RadarPreprocessingConfig config;
  const auto one = joined({{50.0, 0.0, 0.0}}), four = joined(std::vector<Return>(4, {50.0, 0.0, 0.0}));
  EXPECT_DOUBLE_EQ(one[0].sigma_range, config.range_sigma_m);
  EXPECT_DOUBLE_EQ(four[0].sigma_range, 0.5 * config.range_sigma_m);
  EXPECT_DOUBLE_EQ(four[0].sigma_bearing, 0.5 * config.azimuth_sigma_rad);
  EXPECT_DOUBLE_EQ(four[0].sigma_range_rate, 0.5 * config.rate_sigma_mps);
}

}  // namespace
}  // namespace ttf::sensors::radar
