// Rectangles from emulated scans of cars with known pose and size.
#include "nodes/laser/rectangle_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "nodes/laser/laser_preprocessor.h"
#include "nodes/laser/segmentation.h"
#include "tests/nodes/laser/emulated_scan.h"

namespace ttf::nodes::laser {
namespace {

// Through segmentation: a car is one object from any aspect.
LaserObject fitted(const sim::world::ObjectState& car, std::uint32_t sequence,
                   const sim::world::LaserConfig& laser = {}) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  std::vector<LaserObject> objects;
  preprocessor.process(emulated_scan(laser, {car}, sequence), objects);
  EXPECT_EQ(objects.size(), 1U) << "a car at " << car.x << " " << car.y << " heading " << car.heading;
  return objects.empty() ? LaserObject{} : objects[0];
}

// Heading of a long axis is known up to half a turn.
double axis_difference(double a, double b) { return std::remainder(a - b, std::numbers::pi); }

double squared_distance(const LaserObject& o, double ex, double ey) {
  const double determinant = o.sxx * o.syy - o.sxy * o.sxy;
  return (o.syy * ex * ex - 2.0 * o.sxy * ex * ey + o.sxx * ey * ey) / determinant;
}

void expect_positive_definite(const LaserObject& o) {
  EXPECT_GT(o.sxx, 0.0);
  EXPECT_GT(o.syy, 0.0);
  EXPECT_GT(o.sxx * o.syy - o.sxy * o.sxy, 0.0);
}

TEST(RectangleFit, AnLShapeGivesPoseAndSize) {
  sim::world::LaserConfig exact;
  exact.range_sigma_m = exact.miss_at_100m = 0.0;
  for (const double heading : {0.5, 0.8, 1.1, -0.6, -0.9}) {
    const auto car = car_at(15.0, 0.0, heading);
    const LaserObject o = fitted(car, 0, exact);
    ASSERT_TRUE(o.has_heading && o.has_length && o.has_width) << heading;
    EXPECT_NEAR(axis_difference(o.heading, heading), 0.0, 0.02) << heading;
    EXPECT_NEAR(o.length, 4.4, 0.12) << heading;
    EXPECT_NEAR(o.width, 1.8, 0.12) << heading;
    EXPECT_NEAR(o.x, 15.0, 0.12) << heading;
    EXPECT_NEAR(o.y, 0.0, 0.12) << heading;
  }
}

TEST(RectangleFit, ARearAloneLeavesTheLengthOpen) {
  const RectangleConfig config;
  for (const double x : {10.0, 20.0, 40.0}) {
    const LaserObject o = fitted(car_at(x, 0.0, 0.0), 1);
    EXPECT_FALSE(o.has_length);
    EXPECT_TRUE(o.has_width);
    EXPECT_EQ(o.length, config.nominal_length_m);
    EXPECT_EQ(o.sigma_length, config.length_sigma_m);
    EXPECT_NEAR(o.width, 1.8, 3.0 * o.sigma_width);
    EXPECT_NEAR(axis_difference(o.heading, 0.0), 0.0, 3.0 * o.sigma_heading);
    // Half the nominal length behind the rear, uncertain by half its spread; sideways it is seen well.
    EXPECT_NEAR(o.x, x - 2.2 + 0.5 * config.nominal_length_m, 0.1);
    EXPECT_NEAR(std::sqrt(o.sxx), 0.5 * config.length_sigma_m, 0.05);
    EXPECT_LT(std::sqrt(o.syy), 0.2);
  }
}

TEST(RectangleFit, ASideAloneLeavesTheWidthOpen) {
  const LaserObject o = fitted(car_at(15.0, 0.0, std::numbers::pi / 2), 1);
  EXPECT_TRUE(o.has_length);
  EXPECT_FALSE(o.has_width);
  EXPECT_NEAR(o.length, 4.4, 3.0 * o.sigma_length);
  EXPECT_NEAR(axis_difference(o.heading, std::numbers::pi / 2), 0.0, 3.0 * o.sigma_heading);
  EXPECT_EQ(o.width, RectangleConfig{}.nominal_width_m);
}

TEST(RectangleFit, AFewReturnsAreACarSomewhereAroundThem) {
  const std::vector<PlanePoint> points = {{40.0, 3.0, std::atan2(3.0, 40.0), std::hypot(40.0, 3.0)}};
  const LaserObject o = fit_rectangle({}, points);
  EXPECT_FALSE(o.has_heading || o.has_length || o.has_width);
  expect_positive_definite(o);
  EXPECT_GT(o.x, 40.0);
  EXPECT_GT(std::sqrt(o.sxx), 0.9);
  EXPECT_GT(std::sqrt(o.syy), 0.9);
}

TEST(RectangleFit, TurningTheSceneTurnsTheAnswer) {
  // The same returns turned by an angle the search's grid does not favour.
  std::vector<PlanePoint> points, turned;
  std::vector<Segment> segments;
  segment_scan({}, emulated_scan({}, {car_at(18.0, 2.0, 0.7)}, 4), points, segments);
  const double angle = 0.4321, c = std::cos(angle), s = std::sin(angle);
  for (const PlanePoint& p : points)
    turned.push_back({c * p.x - s * p.y, s * p.x + c * p.y, p.azimuth + angle, p.range});
  const LaserObject a = fit_rectangle({}, points), b = fit_rectangle({}, turned);
  EXPECT_NEAR(axis_difference(b.heading - a.heading, angle), 0.0, 0.01);
  EXPECT_NEAR(b.x, c * a.x - s * a.y, 0.05);
  EXPECT_NEAR(b.y, s * a.x + c * a.y, 0.05);
}

// Many cars of the fleet behind the nominal size, all aspects, near and far. A consistent covariance gives
// the centre's error (NEES) a mean of 2. The errors are neither Gaussian nor independent of the aspect, so
// this checks a band. It leans a little to the safe side, and no aspect is overconfident.
TEST(RectangleFit, TheCentresCovarianceIsHonestFromEveryAspect) {
  constexpr int kAspects = 24, kCars = 60;
  RandomStream fleet({17, 0, Purpose::kTest, 0, 0});
  const RectangleConfig config;
  double total = 0.0;
  int outside = 0, wrong_size = 0, sizes = 0, wrong_heading = 0, headings = 0;
  std::uint32_t sequence = 0;
  for (int aspect = 0; aspect < kAspects; ++aspect) {
    double sum = 0.0;
    for (int k = 0; k < kCars; ++k) {
      const double range = fleet.uniform(12.0, 50.0), azimuth = fleet.uniform(-0.4, 0.4);
      const double heading = azimuth + 2.0 * std::numbers::pi * (aspect + fleet.uniform(-0.5, 0.5)) / kAspects;
      const double length = config.nominal_length_m + config.length_sigma_m * fleet.normal();
      const double width = config.nominal_width_m + config.width_sigma_m * fleet.normal();
      const auto car = car_at(range * std::cos(azimuth), range * std::sin(azimuth), heading, length, width);
      const LaserObject o = fitted(car, ++sequence);
      expect_positive_definite(o);
      const double nees = squared_distance(o, o.x - car.x, o.y - car.y);
      sum += nees;
      outside += nees > 9.21;  // 99 % of a Gaussian's
      if (o.has_length) {
        ++sizes;
        wrong_size += std::abs(o.length - length) > 3.0 * o.sigma_length;
      }
      if (o.has_width) {
        ++sizes;
        wrong_size += std::abs(o.width - width) > 3.0 * o.sigma_width;
      }
      if (o.has_heading) {
        ++headings;
        wrong_heading += std::abs(axis_difference(o.heading, heading)) > 3.0 * o.sigma_heading;
      }
    }
    EXPECT_LT(sum / kCars, 4.0) << "overconfident at aspect " << aspect;
    total += sum;
  }
  const double n = kAspects * kCars;
  EXPECT_GT(total / n, 0.8) << "the covariance is far too large";
  EXPECT_LT(total / n, 2.2) << "the covariance is too small";
  EXPECT_LT(outside / n, 0.01);
  EXPECT_LT(wrong_size, 0.03 * sizes);
  EXPECT_LT(wrong_heading, 0.03 * headings);
  EXPECT_GT(sizes, n) << "less than one dimension per car was measured";
}

}  // namespace
}  // namespace ttf::nodes::laser
