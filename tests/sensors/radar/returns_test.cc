#include "sensors/radar/returns.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
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

// The returns of a body whose velocity relative to the radar is (vx, vy), at these places [m].
std::vector<Return> returns_of(double vx, double vy, const std::vector<std::array<double, 2>>& places) {
  std::vector<Return> returns;
  for (const auto& [x, y] : places) {
    const double range = std::hypot(x, y);
    returns.push_back({range, std::atan2(y, x), (x * vx + y * vy) / range});
  }
  return returns;
}

RadarPreprocessingConfig passed_at_15_mps() {
  RadarPreprocessingConfig config;
  config.transverse_speed_mps = 15.0;
  config.azimuth_sigma_rad = 0.008;
  config.rate_span_mps = 60.0;
  return config;
}

// The cars are in neighbouring lanes. The gates alone join them. So it stays where both have one speed.
TEST(RadarReturns, OfTwoCarsSideBySideAreOfTwoObjectsIfTheirSpeedsDiffer) {
  const std::vector<std::array<double, 2>> near{{-6.6, 1.8}, {-8.0, 1.8}, {-6.6, 3.5}},
      far{{-7.1, 5.3}, {-9.0, 5.3}, {-7.1, 6.9}};
  for (const double faster : {2.8, -2.8, 0.0}) {
    std::vector<Return> returns = returns_of(4.0, 0.0, near);
    const std::vector<Return> others = returns_of(4.0 - faster, 0.0, far);
    returns.insert(returns.end(), others.begin(), others.end());
    const auto objects = joined(returns, passed_at_15_mps());
    if (faster == 0.0) {
      EXPECT_EQ(objects.size(), 1U);
      continue;
    }
    ASSERT_EQ(objects.size(), 2U) << faster;
    for (std::size_t i = 0; i < 2; ++i) {
      double rate = 0.0;
      for (std::size_t k = 0; k < 3; ++k) rate += returns[3 * i + k].range_rate / 3.0;
      EXPECT_EQ(objects[i].returns, 3);
      EXPECT_NEAR(objects[i].range_rate, rate, 1e-12);
    }
  }
}

// A turn adds a velocity w (-y, x), which is across every line of sight. So it changes no range rate. Velocities go beyond
// the span. Their range rates are folded.
TEST(RadarReturns, OfOneBodyStayOneObjectWhateverItsMotion) {
  const RadarPreprocessingConfig config = passed_at_15_mps();
  RadarPreprocessingConfig unsure = config;
  unsure.rate_sigma_mps = 50.0;
  std::mt19937 random(7);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int driven = 0;
  for (int draw = 0; draw < 40000; ++draw) {
    const double bearing = 3.0 * uniform(random), along = 55.0 * uniform(random), across = 15.0 * uniform(random);
    const double range = 7.0 + 5.0 * uniform(random);
    double fastest = 0.0;
    std::vector<Return> returns;
    for (int k = 0; k < 4; ++k) {
      const double turn = 2.2 / range * uniform(random);
      fastest = std::max(fastest, std::abs(across * std::cos(turn) - along * std::sin(turn)));
      const double rate = along * std::cos(turn) + across * std::sin(turn) + config.rate_sigma_mps * noise(random);
      returns.push_back({range + 2.0 * uniform(random), bearing + turn + config.azimuth_sigma_rad * noise(random),
                         std::remainder(rate, config.rate_span_mps)});
    }
    if (fastest > config.transverse_speed_mps) continue;
    ++driven;
    EXPECT_EQ(joined(returns, config).size(), joined(returns, unsure).size()) << draw;
  }
  EXPECT_GT(driven, 10000);
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
