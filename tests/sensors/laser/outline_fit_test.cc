// Faces and corners from returns with known truth.
#include "sensors/laser/outline_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {
namespace {

constexpr double kPi = std::numbers::pi, kStep = 0.00436, kNoise = 0.06;
constexpr int kLayers = 4;

Eigen::Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

PlanePoint at(double azimuth, double range) {
  return {range * std::cos(azimuth), range * std::sin(azimuth), azimuth, range};
}

// Returns of a face, between two azimuths.
std::vector<PlanePoint> face(double distance, double normal, double from, double to, RandomStream* noise) {
  std::vector<PlanePoint> points;
  for (double azimuth = from; azimuth <= to; azimuth += kStep)
    for (int layer = 0; layer < kLayers; ++layer)
      points.push_back(
          at(azimuth, distance / std::cos(azimuth - normal) + (noise != nullptr ? kNoise * noise->normal() : 0.0)));
  return points;
}

// Returns of a corner with faces of these lengths [m]; the right one's normal is `normal`.
std::vector<PlanePoint> corner(const Eigen::Vector2d& c, double normal, double right_length, double left_length,
                               RandomStream* noise) {
  const Eigen::Vector2d right = direction(normal), left = direction(normal - kPi / 2);
  const Eigen::Vector2d first = c + right_length * left, last = c + left_length * right;
  const double from = std::atan2(first.y(), first.x()), to = std::atan2(last.y(), last.x());
  std::vector<PlanePoint> points;
  for (double azimuth = from; azimuth <= to; azimuth += kStep) {
    const Eigen::Vector2d u = direction(azimuth);
    const double range = std::max(right.dot(c) / right.dot(u), left.dot(c) / left.dot(u));
    for (int layer = 0; layer < kLayers; ++layer)
      points.push_back(at(azimuth, range + (noise != nullptr ? kNoise * noise->normal() : 0.0)));
  }
  return points;
}

TEST(OutlineFit, ExactReturnsGiveTheFaceExactly) {
  for (const double normal : {-0.9, -0.3, 0.0, 0.4, 1.0}) {
    const auto fit = fit_face(face(20.0, normal, normal - 0.4, normal + 0.1, nullptr), kNoise);
    ASSERT_TRUE(fit) << normal;
    EXPECT_NEAR(fit->distance, 20.0, 1e-9);
    EXPECT_NEAR(fit->normal, normal, 1e-9);
    EXPECT_NEAR(fit->squares, 0.0, 1e-15);
  }
}

TEST(OutlineFit, ExactReturnsGiveTheCornerExactly) {
  const Eigen::Vector2d c(18.0, 3.0);
  for (double aspect = 0.15; aspect < 1.5; aspect += 0.15) {
    const double normal = std::atan2(c.y(), c.x()) + aspect;
    const auto fit = fit_corner(corner(c, normal, 4.4, 1.8, nullptr), kNoise, kStep, {});
    ASSERT_TRUE(fit) << aspect;
    EXPECT_NEAR(fit->squares, 0.0, 1e-9) << aspect;
    // The mixture leans a little to the corner's other places.
    EXPECT_NEAR((fit->corner - c).norm(), 0.0, 2e-3) << aspect;
    EXPECT_NEAR(std::remainder(fit->normal - normal, 2 * kPi), 0.0, 1e-3) << aspect;
  }
}

// NEES of all parameters; its mean over n runs has the standard deviation sqrt(2 dof / n).
TEST(OutlineFit, CovariancesAreThoseOfTheErrors) {
  constexpr int kRuns = 400;
  RandomStream noise({31, 0, Purpose::kTest, 0, 0});
  double of_faces = 0.0, of_corners = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const double normal = noise.uniform(-0.5, 0.5), distance = noise.uniform(10.0, 50.0);
    const auto one = fit_face(face(distance, normal, normal - 0.03, normal + 0.05, &noise), kNoise);
    ASSERT_TRUE(one);
    const Eigen::Vector2d e(one->distance - distance, one->normal - normal);
    of_faces += e.dot(Eigen::LDLT<Eigen::Matrix2d>(one->covariance).solve(e));
    const Eigen::Vector2d c(noise.uniform(10.0, 30.0), noise.uniform(-5.0, 5.0));
    const double turned = std::atan2(c.y(), c.x()) + noise.uniform(0.5, 1.0);
    const auto two = fit_corner(corner(c, turned, 4.4, 1.8, &noise), kNoise, kStep, {});
    ASSERT_TRUE(two);
    Eigen::Vector3d d;
    d << two->corner - c, std::remainder(two->normal - turned, 2 * kPi);
    of_corners += d.dot(Eigen::LDLT<Eigen::Matrix3d>(two->covariance).solve(d));
  }
  EXPECT_NEAR(of_faces / kRuns, 2.0, 4.0 * std::sqrt(4.0 / kRuns));
  EXPECT_NEAR(of_corners / kRuns, 3.0, 5.0 * std::sqrt(6.0 / kRuns));
}

TEST(OutlineFit, ANotchIsNoCorner) {
  // Two faces that meet at their far ends.
  std::vector<PlanePoint> points;
  for (double azimuth = -0.1; azimuth <= 0.1; azimuth += kStep)
    points.push_back(at(azimuth, 20.0 / (std::cos(azimuth) + std::abs(std::sin(azimuth)))));
  EXPECT_FALSE(fit_corner(points, kNoise, kStep, {}));
}

TEST(OutlineFit, ASingleBeamHasNoFace) {
  EXPECT_FALSE(fit_face(std::vector<PlanePoint>{at(0.1, 20.0), at(0.1, 20.1), at(0.1, 19.9)}, kNoise));
}

}  // namespace
}  // namespace ttf::sensors::laser
