// Length and width from lengths, widths and spans.
#include "fusion/tracks/body/extent.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace ttf::fusion::tracks::body {
namespace {

// Oracle: the outline walked along, in the sensor's frame.
double walked(double range, double aspect, const Eigen::Vector2d& size) {
  double low = 10.0, high = -10.0;
  for (int k = 0; k <= 4000; ++k) {
    const double s = 4.0 * k / 4000.0, f = s - std::floor(s);
    const double u = s < 1 ? f : s < 2 ? 1.0 : s < 3 ? 1.0 - f : 0.0;
    const double v = s < 1 ? 0.0 : s < 2 ? f : s < 3 ? 1.0 : 1.0 - f;
    const double along = (u - 0.5) * size(0), across = (v - 0.5) * size(1);
    const double azimuth = std::atan2(std::sin(aspect) * along + std::cos(aspect) * across,
                                      range + std::cos(aspect) * along - std::sin(aspect) * across);
    low = std::min(low, azimuth);
    high = std::max(high, azimuth);
  }
  return high - low;
}

TEST(Subtended, IsTheOutlinesAndItsDerivativesAreTheNumericOnes) {
  const Eigen::Vector2d size(4.4, 1.8);
  for (const double range : {6.0, 20.0, 60.0})
    for (int k = 0; k < 24; ++k) {
      const double aspect = 0.1 + k * std::numbers::pi / 12.0, h = 1e-6;
      const Subtended s = subtended(range, aspect, size);
      EXPECT_NEAR(s.angle, walked(range, aspect, size), 2e-6);
      for (Eigen::Index d = 0; d < 2; ++d) {
        const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(d);
        EXPECT_NEAR(
            s.by_size(d),
            (subtended(range, aspect, size + step).angle - subtended(range, aspect, size - step).angle) / (2 * h),
            1e-7);
      }
    }
}

TEST(Subtended, NothingWhereTheOutlineReachesBehindTheSensor) { EXPECT_EQ(subtended(2.0, 0.0, {4.4, 1.8}).angle, 0.0); }

Aspect seen(double range, double angle, double sigma_angle) { return {range, 0.05, angle, sigma_angle}; }
double span_of(double range, double angle) { return subtended(range, angle, {4.4, 1.8}).angle; }

// A prior that leaves much to estimate.
Extent wide() { return Extent(config::Sizes{.length = 4.5, .length_sigma = 2.0, .width = 1.8, .width_sigma = 0.5}); }

// 20 m ahead, from behind and from the side: the visible side becomes known, the other does not.
TEST(Extent, ASpanMeasuresTheSideTurnedToTheSensor) {
  Extent behind = wide(), beside = wide();
  for (int k = 0; k < 10; ++k) {
    correct_span(behind, seen(20.0, 0.0, 0.02), span_of(20.0, 0.0), 0.002);
    correct_span(beside, seen(20.0, std::numbers::pi / 2, 0.02), span_of(20.0, std::numbers::pi / 2), 0.002);
  }
  EXPECT_TRUE(behind.width_is_measured());
  EXPECT_FALSE(behind.length_is_measured());
  EXPECT_NEAR(behind.size(1), 1.8, 3.0 * std::sqrt(behind.covariance(1, 1)));
  EXPECT_TRUE(beside.length_is_measured());
  EXPECT_FALSE(beside.width_is_measured());
  EXPECT_NEAR(beside.size(0), 4.4, 3.0 * std::sqrt(beside.covariance(0, 0)));
  EXPECT_NEAR(beside.size(1), 1.8, 0.1) << "a side is no width";
}

// At 45 degrees the span is a mixture. Alone it determines neither side; with a length it determines the
// width.
TEST(Extent, AMixtureMeasuresOneWhereTheOtherIsKnown) {
  Extent extent = wide();
  for (int k = 0; k < 10; ++k)
    correct_span(extent, seen(25.0, std::numbers::pi / 4, 0.02), span_of(25.0, std::numbers::pi / 4), 0.001);
  EXPECT_LT(extent.covariance(0, 1), 0.0) << "the longer, the narrower";
  EXPECT_FALSE(extent.width_is_measured());
  const double before = extent.covariance(1, 1);
  correct_length(extent, 4.4, 0.05);
  EXPECT_LT(extent.covariance(1, 1), 0.5 * before);
  EXPECT_NEAR(extent.size(1), 1.8, 3.0 * std::sqrt(extent.covariance(1, 1)));
}

// An aspect with the same error in each of 200 lists: the error stays within the stated one.
TEST(Extent, ErrorsThatRepeatAreNotAveragedAway) {
  RandomStream stream({.seed = 4});
  for (const double angle : {0.0, 0.7, std::numbers::pi / 2, 2.6}) {
    double squares = 0.0;
    int n = 0;
    for (int drive = 0; drive < 200; ++drive) {
      const double sigma = 0.05, off = sigma * stream.normal();
      Extent extent = wide();
      correct_length(extent, 4.4 + 0.2 * stream.normal(), 0.2);
      for (int k = 0; k < 200; ++k)
        correct_span(extent, seen(20.0, angle + off, sigma), span_of(20.0, angle) + 0.002 * stream.normal(), 0.002);
      const Eigen::Vector2d error = extent.size - Eigen::Vector2d(4.4, 1.8);
      squares += error.dot(extent.covariance.inverse() * error);
      ++n;
    }
    EXPECT_LT(squares / n, 2.0 * 1.3) << "aspect " << angle;
    EXPECT_GT(squares / n, 0.2) << "aspect " << angle;
  }
}

TEST(Extent, NorAreThoseOfLengthsAndWidths) {
  Extent extent = wide();
  for (int k = 0; k < 1000; ++k) correct_width(extent, 1.7, 0.1);
  EXPECT_NEAR(extent.size(1), 1.7, 0.01);
  EXPECT_GE(extent.covariance(1, 1), 0.8 * 0.1 * 0.1 - 1e-12);
  EXPECT_LT(extent.covariance(1, 1), 0.81 * 0.1 * 0.1);
}

TEST(Extent, AnUnusableSpanChangesNothing) {
  const auto unchanged = [](const Aspect& aspect, double span) {
    Extent extent = wide();
    correct_span(extent, aspect, span, 0.002);
    return extent.size == wide().size && extent.covariance == wide().covariance;
  };
  EXPECT_TRUE(unchanged(seen(20.0, 0.0, 0.5), 0.1)) << "aspect not known";
  EXPECT_TRUE(unchanged(seen(2.0, 0.0, 0.02), 1.5)) << "outline around the sensor";
  EXPECT_TRUE(unchanged(seen(20.0, 0.0, 0.02), 0.5)) << "10 m across: some other thing";
  EXPECT_FALSE(unchanged(seen(20.0, 0.0, 0.02), 0.1));
}

TEST(Extent, StartsAtThePrior) {
  const Extent extent(
      config::Sizes{.length = 4.65, .length_sigma = 0.37, .width = 1.76, .width_sigma = 0.1, .correlation = 0.82});
  EXPECT_EQ(extent.size, Eigen::Vector2d(4.65, 1.76));
  EXPECT_NEAR(extent.covariance(0, 0), 0.37 * 0.37, 1e-15);
  EXPECT_NEAR(extent.covariance(0, 1), 0.82 * 0.37 * 0.1, 1e-15);
  Extent reported = extent;
  correct_length(reported, 4.95, 0.01);
  EXPECT_NEAR(reported.size(1), 1.76 + 0.3 * 0.82 * 0.1 / 0.37, 1e-3) << "a longer car is wider";
}

TEST(Extent, ForgetsAtTheStatedRate) {
  Extent extent = wide();
  predict(extent, 0.01, 2.0);
  EXPECT_NEAR(extent.covariance(0, 0), 4.0 + 0.02, 1e-12);
  EXPECT_NEAR(extent.covariance(1, 1), 0.25 + 0.02, 1e-12);
}

// Points of an object that lie in a wrong order would make it negative.
TEST(Extent, ASideStaysPositive) {
  config::Sizes prior;
  prior.correlation = 0.5;
  Extent extent(prior);
  for (int k = 0; k < 20; ++k) {
    correct_combination(extent, Eigen::Vector2d::UnitY(), -4.0, 0.01, 0.0);
    EXPECT_GT(extent.size(0), 0.0);
    EXPECT_GT(extent.size(1), 0.0);
    EXPECT_LT(extent.size(1), 0.2);
    EXPECT_GT(extent.covariance.determinant(), 0.0);
  }
  correct_combination(extent, Eigen::Vector2d::UnitX(), -100.0, 1e-4, 0.0);
  EXPECT_GT(extent.size(0), 0.0);
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
