#include "sensors/stereo_camera/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "fusion/tracks/body/anchor.h"
#include "sensors/stereo_camera/model.h"
#include "tests/sensors/laser/emulated_scan.h"

namespace ttf::sensors::stereo_camera {
namespace {

TEST(Triangulation, UndoesTheProjection) {
  CameraCalibration k;
  for (const double depth : {8.0, 25.0, 60.0})
    for (const double bearing : {-0.4, 0.0, 0.2}) {
      const CameraObject o = triangulate(k, bearing, k.focal_px * k.baseline_m / depth, k.focal_px * 1.8 / depth);
      EXPECT_NEAR(o.x, depth, 1e-9);
      EXPECT_NEAR(o.y, depth * std::tan(bearing), 1e-9);
      EXPECT_NEAR(o.span, 1.8 * std::cos(bearing) / depth, 1e-12)
          << "1.8 m across the line of sight, seen from depth / cos";
      EXPECT_NEAR(o.sigma_span, k.width_sigma_px * std::cos(bearing) / k.focal_px, 1e-12);
    }
}

// J diag(variances) J' with J from central differences.
TEST(Triangulation, CovarianceIsThatOfTheNumericJacobian) {
  const CameraCalibration k;
  for (const double depth : {8.0, 25.0, 60.0})
    for (const double bearing : {-0.4, 0.0, 0.2}) {
      const double disparity = k.focal_px * k.baseline_m / depth;
      const CameraObject o = triangulate(k, bearing, disparity, 20.0);
      double sxx = 0, sxy = 0, syy = 0;
      const double sigma[] = {k.bearing_sigma_rad, k.disparity_sigma_px};
      for (int p = 0; p < 2; ++p) {
        const double h = 1e-5;
        const auto at = [&](double step) {
          return triangulate(k, bearing + (p == 0 ? step : 0.0), disparity + (p == 1 ? step : 0.0), 20.0);
        };
        const CameraObject up = at(h), down = at(-h);
        const double dx = (up.x - down.x) / (2 * h) * sigma[p], dy = (up.y - down.y) / (2 * h) * sigma[p];
        sxx += dx * dx;
        sxy += dx * dy;
        syy += dy * dy;
      }
      EXPECT_NEAR(o.sxx / sxx, 1.0, 1e-5);
      EXPECT_NEAR(o.syy / syy, 1.0, 1e-5);
      EXPECT_NEAR(o.sxy, sxy, 1e-5 * std::sqrt(sxx * syy));
    }
}

TEST(Triangulation, DepthUncertaintyGrowsWithTheRangeSquared) {
  const CameraCalibration k;
  const double fb = k.focal_px * k.baseline_m;
  const double near = std::sqrt(triangulate(k, 0.0, fb / 15.0, k.focal_px * 1.7 / 15.0).sxx);
  const double far = std::sqrt(triangulate(k, 0.0, fb / 60.0, k.focal_px * 1.7 / 60.0).sxx);
  EXPECT_NEAR(far / near, 16.0, 0.01);
}

TEST(Triangulation, AVanishingDisparityIsFarAndUncertainButFinite) {
  for (const double disparity : {0.0, 1e-9, -2.0}) {
    const CameraObject o = triangulate({}, 0.1, disparity, 20.0);
    EXPECT_TRUE(std::isfinite(o.x) && std::isfinite(o.y));
    EXPECT_GT(o.x, 1000.0);
    EXPECT_GT(std::sqrt(o.sxx), 1000.0);
    EXPECT_GT(o.sxx * o.syy - o.sxy * o.sxy, 0.0);
  }
}

// Against the sensor model and the tracker's silhouette: a consistent covariance gives the error a weighted mean of 2, for
// cars of all sizes and headings.
TEST(Triangulation, CovarianceIsHonestForTheEmulatedCamera) {
  CameraConfig camera;
  camera.miss_probability = camera.clutter_per_frame = 0.0;
  const CameraCalibration calibration;
  RandomStream draw({23, 0, Purpose::kTest, 0, 0});
  CameraRoom room(1);
  std::vector<CameraDetection> detections;
  std::vector<ObjectId> truth;
  double sum = 0.0;
  int n = 0, outside = 0;
  for (std::uint32_t frame = 0; frame < 3000; ++frame) {
    const double range = draw.uniform(12.0, 40.0), azimuth = draw.uniform(-0.35, 0.35);
    // Every second car is followed or met, the others are turned anyhow.
    const double heading =
        azimuth + (frame % 2 == 0 ? draw.uniform(-0.05, 0.05) : draw.uniform(-std::numbers::pi, std::numbers::pi));
    auto car = laser::car_at(range * std::cos(azimuth), range * std::sin(azimuth), heading);
    car.length = draw.uniform(3.6, 5.0);
    car.width = draw.uniform(1.6, 1.95);
    measure_camera(camera, std::vector<sim::world::ObjectState>{car}, {1, 0, 1, frame}, room, detections, truth);
    ASSERT_EQ(detections.size(), 1U);
    const CameraObject o =
        triangulate(calibration, detections[0].bearing, detections[0].disparity, detections[0].width_px);
    const auto seen = ttf::fusion::tracks::body::silhouette_of({car.x, car.y}, {{car.length, car.width}, heading});
    ASSERT_TRUE(seen);
    const double ex = o.x - seen->point.at.x(), ey = o.y - seen->point.at.y();
    const double determinant = o.sxx * o.syy - o.sxy * o.sxy;
    const double nees = (o.syy * ex * ex - 2.0 * o.sxy * ex * ey + o.sxx * ey * ey) / determinant;
    sum += nees;
    outside += nees > 9.21;
    ++n;
  }
  EXPECT_GT(sum / n, 1.8);
  EXPECT_LT(sum / n, 2.2);
  EXPECT_LT(outside, 0.015 * n);
}

}  // namespace
}  // namespace ttf::sensors::stereo_camera
