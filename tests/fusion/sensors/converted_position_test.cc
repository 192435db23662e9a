// Range and bearing converted into a position: unbiased, and as uncertain as stated. Against draws and the
// published formula.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/random.h"
#include "fusion/sensors/converted_position.h"

namespace ttf::fusion::sensors {
namespace {

// As printed (Longbin et al. 1998), in Cartesian axes.
Eigen::Matrix2d published(double r, double b, double sr, double sb) {
  const double lambda = std::exp(-0.5 * sb * sb), l4 = std::pow(lambda, 4), c = 1.0 / (lambda * lambda) - 2.0;
  const double sum = 0.5 * (r * r + sr * sr);
  Eigen::Matrix2d m;
  m(0, 0) = c * r * r * std::pow(std::cos(b), 2) + sum * (1.0 + l4 * std::cos(2.0 * b));
  m(1, 1) = c * r * r * std::pow(std::sin(b), 2) + sum * (1.0 - l4 * std::cos(2.0 * b));
  m(0, 1) = m(1, 0) = c * r * r * std::sin(b) * std::cos(b) + sum * l4 * std::sin(2.0 * b);
  return m;
}

TEST(ConvertedPosition, IsThePublishedConversion) {
  for (const double b : {-2.5, -0.3, 0.0, 0.7, 3.0})
    for (const double sb : {0.01, 0.1, 0.4}) {
      const Observation converted = converted_position(50.0, b, 0.5, sb);
      EXPECT_EQ(converted.kind, ObservationKind::kPosition);
      const Eigen::Matrix2d expected = published(50.0, b, 0.5, sb);
      const Eigen::Matrix2d r = converted.r.topLeftCorner<2, 2>();
      EXPECT_LT((r - expected).norm(), 1e-9 * expected.norm()) << b << " " << sb;
      EXPECT_NEAR(converted.z(0), 50.0 * std::cos(b) * std::exp(0.5 * sb * sb), 1e-12 * 50.0);
    }
}

TEST(ConvertedPosition, IsUnbiasedAndConsistentWhereTheBearingIsPoor) {
  const double range = 100.0, bearing = 0.6, sr = 1.0, sb = 0.3;
  const Eigen::Vector2d truth(range * std::cos(bearing), range * std::sin(bearing));
  RandomStream stream({.seed = 11, .purpose = Purpose::kTest});
  constexpr int kDraws = 40'000;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double nees = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const Observation z = converted_position(range + sr * stream.normal(), bearing + sb * stream.normal(), sr, sb);
    const Eigen::Vector2d error = z.z.head<2>() - truth;
    mean += error / kDraws;
    nees += error.dot(z.r.topLeftCorner<2, 2>().inverse() * error) / kDraws;
  }
  // Without the factor 1 / lambda, the mean would be off by 4.4 m along the line of sight.
  EXPECT_LT(mean.norm(), 0.6);
  EXPECT_NEAR(nees, 2.0, 0.3);
}

TEST(ConvertedPosition, LittleNoiseFarAwayIsNotLost) {
  const Observation z = converted_position(1e5, 0.0, 0.01, 1e-4);
  EXPECT_NEAR(z.r(0, 0), 1e-4 + 1.5e10 * 1e-16, 1e-8)
      << "1.5 r^2 sb^4 is what the bearing adds along the line of sight";
  EXPECT_NEAR(z.r(1, 1), 1e10 * 1e-8, 1e-5);
}

// To first order, from a sensor mounted aside and rotated: J R J' with the Jacobian by differences.
TEST(PlanePosition, OfRangeAndBearingIsTheFirstOrderTransformationFromTheSensor) {
  Mounting from;
  from.position = {3.5, -0.8};
  from.yaw = 0.4;
  Observation z;
  z.kind = ObservationKind::kRangeBearingRate;
  z.z << 40.0, -0.3, 2.0;
  z.r.diagonal() << 0.09, 0.0004, 0.25;
  const auto place = [&](double range, double bearing) {
    return Eigen::Vector2d(from.position +
                           range * Eigen::Vector2d(std::cos(bearing + from.yaw), std::sin(bearing + from.yaw)));
  };
  constexpr double kStep = 1e-6;
  Eigen::Matrix2d j;
  j.col(0) = (place(40.0 + kStep, -0.3) - place(40.0 - kStep, -0.3)) / (2.0 * kStep);
  j.col(1) = (place(40.0, -0.3 + kStep) - place(40.0, -0.3 - kStep)) / (2.0 * kStep);
  const Eigen::Matrix2d expected = j * z.r.topLeftCorner<2, 2>() * j.transpose();

  const PlanePosition plane = plane_position(z, from);
  EXPECT_NEAR(plane.x, place(40.0, -0.3).x(), 1e-12);
  EXPECT_NEAR(plane.y, place(40.0, -0.3).y(), 1e-12);
  EXPECT_NEAR(plane.sxx, expected(0, 0), 1e-7);
  EXPECT_NEAR(plane.sxy, expected(0, 1), 1e-7);
  EXPECT_NEAR(plane.syy, expected(1, 1), 1e-7);
}

TEST(PlanePosition, OfAPositionIsWhatItSays) {
  Observation z;
  z.z << 7.0, -2.0, 0.0;
  z.r.topLeftCorner<2, 2>() << 0.5, 0.1, 0.1, 0.3;
  Mounting aside;
  aside.position = {1.0, 1.0};
  const PlanePosition plane = plane_position(z, aside);
  EXPECT_EQ(plane.x, 7.0);
  EXPECT_EQ(plane.y, -2.0);
  EXPECT_EQ(plane.sxx, 0.5);
  EXPECT_EQ(plane.sxy, 0.1);
  EXPECT_EQ(plane.syy, 0.3);
}

TEST(PlanePosition, IndependentErrorsAddUp) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  PlanePosition turned, added;
  turned.set_errors(c, s, 4.0, 0.25);
  added.add_error(c, s, 4.0);
  added.add_error(-s, c, 0.25);
  EXPECT_NEAR(turned.sxx, added.sxx, 1e-15);
  EXPECT_NEAR(turned.sxy, added.sxy, 1e-15);
  EXPECT_NEAR(turned.syy, added.syy, 1e-15);
  PlanePosition twice = turned;
  twice.add_errors(c, s, 4.0, 0.25);
  EXPECT_NEAR(twice.sxy, 2.0 * turned.sxy, 1e-15);
  EXPECT_NEAR(twice.sigma_x(), std::sqrt(2.0 * turned.sxx), 1e-15);
  EXPECT_NEAR(twice.correlation(), turned.correlation(), 1e-15);
}

}  // namespace
}  // namespace ttf::fusion::sensors
