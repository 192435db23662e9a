#include "nodes/camera/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "sim/world/camera.h"
#include "tests/nodes/laser/emulated_scan.h"

namespace ttf::nodes::camera {
namespace {

TEST(Triangulation, UndoesTheProjection) {
  CameraCalibration k;
  for (const double depth : {8.0, 25.0, 60.0})
    for (const double bearing : {-0.4, 0.0, 0.2}) {
      const CameraObject o = triangulate(k, bearing, k.focal_px * k.baseline_m / depth, k.focal_px * 1.8 / depth);
      // The point seen, then half a length on along the line of sight.
      EXPECT_NEAR(o.x - k.half_length_m * std::cos(bearing), depth, 1e-9);
      EXPECT_NEAR(o.y - k.half_length_m * std::sin(bearing), depth * std::tan(bearing), 1e-9);
      EXPECT_NEAR(o.width, 1.8, 1e-9);
      EXPECT_NEAR(o.span, 1.8 * std::cos(bearing) / depth, 1e-12)
          << "1.8 m across the line of sight, seen from depth / cos";
      EXPECT_NEAR(o.sigma_span, k.width_sigma_px * std::cos(bearing) / k.focal_px, 1e-12);
    }
}

// Seen from the side, the centre is half the width behind the outline; in between, by the mean chord.
TEST(Triangulation, AWideSilhouetteIsATurnedCar) {
  const CameraCalibration k;
  const double depth = 30.0, disparity = k.focal_px * k.baseline_m / depth;
  const auto behind = [&](double width) {
    return triangulate(k, 0.0, disparity, k.focal_px * width / depth).x - depth;
  };
  EXPECT_NEAR(behind(4.4), 0.9, 1e-9);
  EXPECT_NEAR(behind(3.0), 4.4 * 1.8 / 3.0 / 2.0, 1e-9);
  EXPECT_NEAR(behind(1.0), 2.2, 1e-9);
  EXPECT_NEAR(behind(9.0), 0.9, 1e-9);
}

// J diag(variances) J' with J from central differences, and the perspective of a turned car across the line
// of sight.
TEST(Triangulation, CovarianceIsThatOfTheNumericJacobian) {
  const CameraCalibration k;
  for (const double depth : {8.0, 25.0, 60.0})
    for (const double bearing : {-0.4, 0.0, 0.2})
      for (const double metres : {1.2, 2.4, 3.9, 6.0}) {
        const double disparity = k.focal_px * k.baseline_m / depth, width = k.focal_px * metres / depth;
        const CameraObject o = triangulate(k, bearing, disparity, width);
        double sxx = 0, sxy = 0, syy = 0, width_variance = 0;
        const double sigma[] = {k.bearing_sigma_rad, k.disparity_sigma_px, k.width_sigma_px};
        for (int p = 0; p < 3; ++p) {
          const double h = 1e-5;
          const auto at = [&](double step) {
            return triangulate(k, bearing + (p == 0 ? step : 0.0), disparity + (p == 1 ? step : 0.0),
                               width + (p == 2 ? step : 0.0));
          };
          const CameraObject up = at(h), down = at(-h);
          const double dx = (up.x - down.x) / (2 * h) * sigma[p], dy = (up.y - down.y) / (2 * h) * sigma[p];
          const double dw = (up.width - down.width) / (2 * h) * sigma[p];
          sxx += dx * dx;
          sxy += dx * dy;
          syy += dy * dy;
          width_variance += dw * dw;
        }
        // Along and across the line of sight: the half length's spread, and u v / range.
        const double c = std::cos(bearing), s = std::sin(bearing), range = depth / c;
        const double seen = std::min(4.4, std::max(1.8, metres)), u = seen / 2;
        const double v = std::sqrt((4.4 * 4.4 + 1.8 * 1.8) / 4 - u * u);
        const double along = k.half_length_sigma_m * k.half_length_sigma_m;
        const double across = std::pow(u * v / range, 2) * (1.0 - std::pow(1.8 / seen, 2));
        sxx += c * c * along + s * s * across;
        syy += s * s * along + c * c * across;
        sxy += c * s * (along - across);
        EXPECT_NEAR(o.sxx / sxx, 1.0, 1e-5);
        EXPECT_NEAR(o.syy / syy, 1.0, 1e-5);
        EXPECT_NEAR(o.sxy, sxy, 1e-5 * std::sqrt(sxx * syy));
        EXPECT_NEAR(o.sigma_width * o.sigma_width / width_variance, 1.0, 1e-5);
      }
}

TEST(Triangulation, DepthUncertaintyGrowsWithTheRangeSquared) {
  CameraCalibration k;
  k.half_length_sigma_m = 0.001;
  const double fb = k.focal_px * k.baseline_m;
  const double near = std::sqrt(triangulate(k, 0.0, fb / 15.0, k.focal_px * 1.7 / 15.0).sxx);
  const double far = std::sqrt(triangulate(k, 0.0, fb / 60.0, k.focal_px * 1.7 / 60.0).sxx);
  EXPECT_NEAR(far / near, 16.0, 0.01);
}

TEST(Triangulation, AVanishingDisparityIsFarAndUncertainButFinite) {
  for (const double disparity : {0.0, 1e-9, -2.0}) {
    const CameraObject o = triangulate({}, 0.1, disparity, 20.0);
    EXPECT_TRUE(std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.width));
    EXPECT_GT(o.x, 1000.0);
    EXPECT_GT(std::sqrt(o.sxx), 1000.0);
    EXPECT_GT(o.sxx * o.syy - o.sxy * o.sxy, 0.0);
  }
}

// Against the sensor model: a consistent covariance gives the error of a car's centre a weighted mean of 2.
TEST(Triangulation, CovarianceIsHonestForTheEmulatedCamera) {
  sim::world::CameraConfig camera;
  camera.miss_probability = camera.clutter_per_frame = 0.0;
  const CameraCalibration calibration;
  RandomStream draw({23, 0, Purpose::kTest, 0, 0});
  sim::world::CameraRoom room(1);
  std::vector<sim::world::CameraDetection> detections;
  std::vector<ObjectId> truth;
  double sum = 0.0;
  int n = 0, outside = 0;
  for (std::uint32_t frame = 0; frame < 3000; ++frame) {
    const double range = draw.uniform(12.0, 40.0), azimuth = draw.uniform(-0.35, 0.35);
    // Every second car is followed or met, the others are turned anyhow.
    const double heading =
        azimuth + (frame % 2 == 0 ? draw.uniform(-0.05, 0.05) : draw.uniform(-std::numbers::pi, std::numbers::pi));
    const auto car = laser::car_at(range * std::cos(azimuth), range * std::sin(azimuth), heading);
    sim::world::measure_camera(camera, std::vector<sim::world::ObjectState>{car}, 1, 0, 1, frame, room, detections,
                               truth);
    ASSERT_EQ(detections.size(), 1U);
    const CameraObject o =
        triangulate(calibration, detections[0].bearing, detections[0].disparity, detections[0].width_px);
    const double ex = o.x - car.x, ey = o.y - car.y, determinant = o.sxx * o.syy - o.sxy * o.sxy;
    const double nees = (o.syy * ex * ex - 2.0 * o.sxy * ex * ey + o.sxx * ey * ey) / determinant;
    sum += nees;
    outside += nees > 9.21;
    ++n;
  }
  EXPECT_GT(sum / n, 1.0);
  EXPECT_LT(sum / n, 2.6);
  EXPECT_LT(outside, 0.03 * n);
}

}  // namespace
}  // namespace ttf::nodes::camera
