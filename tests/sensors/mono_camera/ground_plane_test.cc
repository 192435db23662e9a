#include "sensors/mono_camera/ground_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "fusion/tracks/body/anchor.h"
#include "sensors/mono_camera/model.h"
#include "tests/sensors/laser/emulated_scan.h"

namespace ttf::sensors::mono_camera {
namespace {

// The camera's box of a car, and its silhouette as the tracker has it.
struct Look {
  PictureBox box;
  Eigen::Vector2d silhouette = Eigen::Vector2d::Zero();
  double span = 0.0;
};
class Camera {
 public:
  explicit Camera(const MonoCameraConfig& config) : config_(config), room_(1) {}
  Look look(const sim::world::ObjectState& car, std::uint32_t frame) {
    measure_mono_camera(config_, std::vector<sim::world::ObjectState>{car}, {1, 0, 1, frame}, room_, boxes_, truth_);
    EXPECT_EQ(boxes_.size(), 1U);
    const auto seen = ttf::fusion::tracks::body::silhouette_of({car.x, car.y}, {{car.length, car.width}, car.heading});
    const MonoBox& box = boxes_.at(0);
    return {{box.left, box.right, box.bottom, static_cast<int>(box.seen_as)}, seen->point.at, seen->span};
  }

 private:
  MonoCameraConfig config_;
  MonoCameraRoom room_;
  std::vector<MonoBox> boxes_;
  std::vector<ObjectId> truth_;
};

MonoCameraConfig sure_camera() {
  MonoCameraConfig config;
  config.detection_probability = 1.0;
  config.half_detected_px = 0.0;
  config.detection_slope_px = 0.01;
  config.class_confusion = config.clutter_per_frame = 0.0;
  return config;
}
MonoCameraConfig exact_camera() {
  MonoCameraConfig config = sure_camera();
  config.column_sigma_px = config.row_sigma_px = 0.0;
  return config;
}
MonoCalibration sharp() {
  MonoCalibration calibration;
  calibration.column_sigma_px = calibration.row_sigma_px = 0.01;
  return calibration;
}

TEST(GroundPlane, FindsTheRearAhead) {
  Camera camera(exact_camera());
  const GroundPlane plane(sharp());
  for (const double x : {10.0, 25.0, 60.0}) {
    const Look look = camera.look(laser::car_at(x, 0.0, 0.0), 0);
    const stereo_camera::CameraObject o = plane.locate(look.box);
    EXPECT_NEAR(o.x, look.silhouette.x(), 0.45) << "turned a little, it would have the same width";
    EXPECT_NEAR(o.y, 0.0, 1e-9);
    EXPECT_NEAR(o.span, look.span, 1e-9);
    EXPECT_LT(std::abs(o.x - look.silhouette.x()), 3.0 * o.sigma_x());
  }
}

// From the nearest point to the mean distance it is more than a metre for a car that is turned by 45 degrees.
TEST(GroundPlane, TheWidthShowsTheTurn) {
  Camera camera(exact_camera());
  const GroundPlane plane(sharp());
  for (const double turn : {-0.8, -0.4, 0.4, 0.8})
    for (const double y : {-5.0, 0.0, 5.0}) {
      const double x = 25.0, bearing = std::atan2(y, x);
      const Look look = camera.look(laser::car_at(x, y, bearing + turn), 0);
      const stereo_camera::CameraObject o = plane.locate(look.box);
      const double error = std::hypot(o.x, o.y) - look.silhouette.norm();
      EXPECT_LT(std::abs(error), 0.5) << turn << " at " << y;
    }
}

TEST(GroundPlane, UncertaintyGrowsWithTheRangeSquared) {
  MonoCalibration calibration;
  const double fh = calibration.focal_px * calibration.height_m;
  const auto variance = [&](double depth, double pitch_sigma) {
    calibration.pitch_sigma_rad = pitch_sigma;
    const double half = 0.5 * calibration.focal_px * 1.8 / depth;
    return GroundPlane(calibration).locate({-half, half, fh / depth}).sxx;
  };
  EXPECT_NEAR(std::sqrt(variance(60.0, 0.0) / variance(30.0, 0.0)), 4.0, 0.5) << "and the spread of the turn";
  // The pitch's part alone.
  for (const double depth : {20.0, 40.0})
    EXPECT_NEAR(std::sqrt(variance(depth, 0.005)) / (0.005 * depth * depth / calibration.height_m), 1.0, 0.15);
}

TEST(GroundPlane, AKnownPitchIsTakenOut) {
  MonoCameraConfig config = exact_camera();
  config.pitch.fixed = 0.004;
  MonoCalibration calibration = sharp();
  calibration.pitch_rad = 0.004;
  const Look tilted = Camera(config).look(laser::car_at(30.0, 2.0, 0.1), 0);
  const Look level = Camera(exact_camera()).look(laser::car_at(30.0, 2.0, 0.1), 0);
  EXPECT_NEAR(GroundPlane(calibration).locate(tilted.box).x, GroundPlane(sharp()).locate(level.box).x, 1e-6);
}

TEST(GroundPlane, AtTheHorizonItIsFarAndUncertainButFinite) {
  for (const double bottom : {0.2, 0.0, -30.0})
    for (const double width : {2.0, 800.0}) {
      const stereo_camera::CameraObject o = GroundPlane({}).locate({-10.0, -10.0 + width, bottom});
      EXPECT_TRUE(std::isfinite(o.x) && std::isfinite(o.y));
      EXPECT_GT(o.x, 1000.0);
      EXPECT_GT(std::sqrt(o.sxx), 1000.0);
      EXPECT_GT(o.sxx * o.syy - o.sxy * o.sxy, 0.0);
    }
}

// Against the sensor model and the tracker's silhouette: a consistent covariance gives the error a weighted mean of 2, for
// cars of the usual sizes and of all headings.
TEST(GroundPlane, CovarianceIsHonestForTheEmulatedCamera) {
  Camera camera(sure_camera());
  const GroundPlane plane({});
  RandomStream draw({29, 0, Purpose::kTest, 0, 0});
  double sum = 0.0;
  int n = 0, outside = 0;
  for (std::uint32_t frame = 0; frame < 4000; ++frame) {
    const double range = draw.uniform(10.0, 45.0), azimuth = draw.uniform(-0.35, 0.35);
    auto car = laser::car_at(range * std::cos(azimuth), range * std::sin(azimuth),
                             azimuth + draw.uniform(-std::numbers::pi, std::numbers::pi));
    car.length = 4.4 + 0.5 * draw.normal();
    car.width = 1.8 + 0.15 * draw.normal();
    const Look look = camera.look(car, frame);
    const stereo_camera::CameraObject o = plane.locate(look.box);
    const double ex = o.x - look.silhouette.x(), ey = o.y - look.silhouette.y();
    const double determinant = o.sxx * o.syy - o.sxy * o.sxy;
    const double nees = (o.syy * ex * ex - 2.0 * o.sxy * ex * ey + o.sxx * ey * ey) / determinant;
    sum += nees;
    outside += nees > 9.21;
    ++n;
  }
  EXPECT_GT(sum / n, 1.7);
  EXPECT_LT(sum / n, 2.3);
  EXPECT_LT(outside, 0.02 * n);
}

}  // namespace
}  // namespace ttf::sensors::mono_camera
