#include "sensors/stereo_camera/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/sensors/car_at.h"

namespace ttf::sensors::stereo_camera {
namespace {

constexpr ObjectId kClutter{0xffff};

CameraConfig exact_camera() {
  CameraConfig config;
  config.disparity_sigma_px = config.bearing_sigma_rad = config.width_sigma_px = 0.0;
  config.miss_probability = config.clutter_per_frame = 0.0;
  return config;
}

struct Frame {
  std::vector<CameraDetection> detections;
  std::vector<ObjectId> truth;
};
Frame frame(const CameraConfig& config, const std::vector<ObjectState>& objects, std::uint32_t sequence = 0) {
  Frame f;
  CameraRoom room(objects.size());
  measure_camera(config, objects, {1, 0, 1, sequence}, room, f.detections, f.truth);
  EXPECT_EQ(f.detections.size(), f.truth.size());
  return f;
}

TEST(Camera, ACarStraightAheadIsSeenAtItsRear) {
  const CameraConfig config = exact_camera();
  for (const double x : {10.0, 30.0, 70.0}) {
    const auto [detections, truth] = frame(config, {car_at(0, x, 0.0)});
    ASSERT_EQ(detections.size(), 1U);
    const double rear = x - 2.2;
    EXPECT_NEAR(detections[0].bearing, 0.0, 1e-12);
    EXPECT_NEAR(detections[0].disparity, config.focal_px * config.baseline_m / rear, 1e-9);
    // The silhouette is the rear's: 1.8 m at that depth, to the second order of its angle.
    EXPECT_NEAR(detections[0].width_px, config.focal_px * 2.0 * std::atan(0.9 / rear), 1e-9);
  }
}

TEST(Camera, ATurnedCarIsSeenInTheMiddleOfItsSilhouette) {
  const CameraConfig config = exact_camera();
  // Broadside, 20 m ahead and to the left: the near side lies at y-parallel x = 20 - 0.9.
  const auto [detections, truth] = frame(config, {car_at(0, 20.0, 3.0, std::numbers::pi / 2)});
  ASSERT_EQ(detections.size(), 1U);
  const double right = std::atan2(3.0 - 2.2, 20.9), left = std::atan2(3.0 + 2.2, 19.1);
  // Right edge: the nearer of the two right corners in angle is the far one (0.8 / 20.9).
  EXPECT_NEAR(detections[0].bearing, 0.5 * (left + right), 1e-12);
  const double depth = config.focal_px * config.baseline_m / detections[0].disparity;
  EXPECT_GT(depth, 19.1 - 1e-9);
  EXPECT_LT(depth, 19.3) << "almost all of what shows is the near side";
}

// z = f b / d: sigma_z = z^2 sigma_d / (f b).
TEST(Camera, DepthNoiseGrowsWithTheRangeSquared) {
  CameraConfig config = exact_camera();
  config.disparity_sigma_px = CameraConfig{}.disparity_sigma_px;
  config.bearing_sigma_rad = CameraConfig{}.bearing_sigma_rad;
  const double fb = config.focal_px * config.baseline_m;
  constexpr int kFrames = 2000;
  for (const double x : {12.0, 24.0, 48.0}) {
    const double rear = x - 2.2;
    double sum = 0, squared = 0, bearing_squared = 0;
    for (std::uint32_t k = 0; k < kFrames; ++k) {
      const auto [detections, truth] = frame(config, {car_at(0, x, 0.0)}, k);
      ASSERT_EQ(detections.size(), 1U);
      const double error = fb / detections[0].disparity - rear;
      sum += error;
      squared += error * error;
      bearing_squared += detections[0].bearing * detections[0].bearing;
    }
    const double sigma = rear * rear * config.disparity_sigma_px / fb;
    // Second order adds (sigma / z)^2 z to the mean and up to 1 % to the variance here.
    EXPECT_NEAR(sum / kFrames, sigma * sigma / rear, 4.0 * sigma / std::sqrt(kFrames)) << x;
    EXPECT_NEAR(squared / kFrames / (sigma * sigma), 1.0, 4.0 * std::sqrt(2.0 / kFrames) + 0.01) << x;
    const double bearing_variance = config.bearing_sigma_rad * config.bearing_sigma_rad;
    EXPECT_NEAR(bearing_squared / kFrames / bearing_variance, 1.0, 4.0 * std::sqrt(2.0 / kFrames));
  }
}

TEST(Camera, MissesAndClutterAreAsOftenAsStated) {
  CameraConfig config;
  config.miss_probability = 0.2;
  config.clutter_per_frame = 0.7;
  constexpr int kFrames = 4000;
  int seen = 0, clutter = 0, clutter_squared = 0;
  for (std::uint32_t k = 0; k < kFrames; ++k) {
    const auto [detections, truth] = frame(config, {car_at(0, 30.0, 1.0)}, k);
    const auto false_ones = static_cast<int>(std::count(truth.begin(), truth.end(), kClutter));
    seen += static_cast<int>(truth.size()) - false_ones;
    clutter += false_ones;
    clutter_squared += false_ones * false_ones;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_LE(std::abs(detections[i].bearing), config.half_field_rad + 6.0 * config.bearing_sigma_rad);
      EXPECT_GT(detections[i].disparity, 0.0);
      EXPECT_GT(detections[i].width_px, 0.0);
    }
  }
  EXPECT_NEAR(seen / double{kFrames}, 0.8, 4.0 * std::sqrt(0.2 * 0.8 / kFrames));
  const double mean = clutter / double{kFrames};
  EXPECT_NEAR(mean, 0.7, 4.0 * std::sqrt(0.7 / kFrames));
  // Poisson: the variance is the mean.
  EXPECT_NEAR(clutter_squared / double{kFrames} - mean * mean, 0.7, 0.1);
}

TEST(Camera, HiddenFarAndOutsideObjectsAreNotSeen) {
  const CameraConfig config = exact_camera();
  const auto hidden = frame(config, {car_at(0, 40.0, 0.0), car_at(1, 15.0, 0.2)});
  EXPECT_EQ(hidden.truth, std::vector<ObjectId>{ObjectId{1}});
  EXPECT_EQ(frame(config, {car_at(0, 40.0, 5.0), car_at(1, 15.0, 0.2)}).truth.size(), 2U);
  EXPECT_TRUE(frame(config, {car_at(0, 95.0, 0.0)}).truth.empty());
  EXPECT_TRUE(frame(config, {car_at(0, 20.0, 15.0)}).truth.empty());
  EXPECT_TRUE(frame(config, {car_at(0, -20.0, 0.0)}).truth.empty());
}

// A mast sees over near objects. Behind them, only their shadow's share of the distance is hidden.
TEST(Camera, FromAboveOnlyWhatIsInAShadowIsHidden) {
  CameraConfig config = exact_camera();
  config.shadow = 0.5;
  EXPECT_EQ(frame(config, {car_at(0, 40.0, 0.0), car_at(1, 15.0, 0.2)}).truth.size(), 2U);
  EXPECT_EQ(frame(config, {car_at(0, 21.0, 0.0), car_at(1, 15.0, 0.2)}).truth, std::vector<ObjectId>{ObjectId{1}});
}

TEST(Camera, OneObjectsVisibilityNeverShiftsAnothersNoise) {
  CameraConfig config;
  config.clutter_per_frame = config.miss_probability = 0.0;
  for (std::uint32_t k = 0; k < 20; ++k) {
    const auto both = frame(config, {car_at(0, 20.0, -5.0), car_at(1, 40.0, 5.0)}, k);
    const auto behind = frame(config, {car_at(0, -20.0, -5.0), car_at(1, 40.0, 5.0)}, k);
    ASSERT_EQ(both.truth.size(), 2U);
    ASSERT_EQ(behind.truth.size(), 1U);
    EXPECT_EQ(both.detections[1].bearing, behind.detections[0].bearing);
    EXPECT_EQ(both.detections[1].disparity, behind.detections[0].disparity);
    EXPECT_EQ(both.detections[1].width_px, behind.detections[0].width_px);
  }
}

TEST(Camera, DrawsBelongToTheSequence) {
  const CameraConfig config;
  const std::vector<ObjectState> cars = {car_at(0, 20.0, -5.0), car_at(1, 40.0, 5.0)};
  bool differs = false;
  for (std::uint32_t k = 0; k < 10; ++k) {
    const Frame first = frame(config, cars, k), again = frame(config, cars, k), next = frame(config, cars, k + 1);
    ASSERT_EQ(first.truth, again.truth);
    for (std::size_t i = 0; i < first.truth.size(); ++i) {
      EXPECT_EQ(first.detections[i].disparity, again.detections[i].disparity);
      differs |= i < next.truth.size() && next.detections[i].disparity != first.detections[i].disparity;
    }
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace ttf::sensors::stereo_camera
