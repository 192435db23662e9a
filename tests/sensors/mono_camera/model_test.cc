#include "sensors/mono_camera/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sensors/car_at.h"

namespace ttf::sensors::mono_camera {
namespace {

constexpr ObjectId kFalseBox{0xffff};

MonoCameraConfig exact_mono_camera() {
  MonoCameraConfig config;
  config.column_sigma_px = config.row_sigma_px = 0.0;
  config.detection_probability = 1.0;
  config.half_detected_px = 0.0;
  config.detection_slope_px = 0.01;
  config.class_confusion = config.clutter_per_frame = 0.0;
  return config;
}

struct Picture {
  std::vector<MonoBox> boxes;
  std::vector<ObjectId> truth;
};
Picture picture(const MonoCameraConfig& config, const std::vector<ObjectState>& objects, std::uint32_t sequence = 0) {
  Picture f;
  MonoCameraRoom room(objects.size());
  measure_mono_camera(config, objects, {1, 0, 1, sequence}, room, f.boxes, f.truth);
  EXPECT_EQ(f.boxes.size(), f.truth.size());
  return f;
}

// The range is f h / v, and the height over ground h (v - top) / v.
TEST(MonoCamera, ACarAheadStandsOnTheGround) {
  const MonoCameraConfig config = exact_mono_camera();
  for (const double x : {10.0, 30.0, 60.0}) {
    const auto [boxes, truth] = picture(config, {car_at(0, x, 0.0)});
    ASSERT_EQ(boxes.size(), 1U);
    const double rear = x - 2.2;
    EXPECT_NEAR(config.focal_px * config.height_m / boxes[0].bottom, rear, 1e-9);
    EXPECT_NEAR(config.height_m * (boxes[0].bottom - boxes[0].top) / boxes[0].bottom, 1.5, 1e-9);
    EXPECT_NEAR(boxes[0].right - boxes[0].left, config.focal_px * 1.8 / rear, 1e-9);
    EXPECT_EQ(boxes[0].seen_as, sim::world::traffic::ObjectClass::kCar);
  }
  const auto [left, truth] = picture(config, {car_at(0, 30.0, 5.0)});
  ASSERT_EQ(left.size(), 1U);
  EXPECT_LT(left[0].right, 0.0) << "columns count to the right";
}

// Looking down by e lifts the horizon by f tan e, and moves the range by e x^2 / h.
TEST(MonoCamera, PitchMovesAllRangesTogether) {
  MonoCameraConfig config = exact_mono_camera();
  config.pitch.fixed = 0.002;
  const auto [boxes, truth] = picture(config, {car_at(0, 20.0, -4.0), car_at(1, 40.0, 4.0)});
  ASSERT_EQ(boxes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const double rear = i == 0 ? 17.8 : 37.8;
    EXPECT_NEAR(boxes[i].bottom, config.focal_px * std::tan(std::atan(config.height_m / rear) - 0.002), 1e-9);
    const double range = config.focal_px * config.height_m / boxes[i].bottom;
    EXPECT_NEAR((range - rear) / (0.002 * rear * rear / config.height_m), 1.0, 0.08);
  }
}

// x = f h / v: sigma_x = x^2 sigma_v / (f h).
TEST(MonoCamera, RangeNoiseGrowsWithTheRangeSquared) {
  MonoCameraConfig config = exact_mono_camera();
  config.row_sigma_px = config.column_sigma_px = 0.5;
  const double fh = config.focal_px * config.height_m;
  constexpr int kFrames = 2000;
  for (const double x : {12.0, 24.0, 48.0}) {
    const double rear = x - 2.2;
    double sum = 0.0, squared = 0.0, width = 0.0, width_squared = 0.0;
    for (std::uint32_t k = 0; k < kFrames; ++k) {
      const auto [boxes, truth] = picture(config, {car_at(0, x, 0.0)}, k);
      ASSERT_EQ(boxes.size(), 1U);
      const double error = fh / boxes[0].bottom - rear;
      const double wider = boxes[0].right - boxes[0].left - config.focal_px * 1.8 / rear;
      sum += error;
      squared += error * error;
      width += wider;
      width_squared += wider * wider;
    }
    const double sigma = rear * rear * config.row_sigma_px / fh, narrow = 4.0 / std::sqrt(kFrames);
    EXPECT_NEAR(sum / kFrames, sigma * sigma / rear, narrow * sigma) << x;
    EXPECT_NEAR(squared / kFrames / (sigma * sigma), 1.0, narrow * std::sqrt(2.0) + 0.02) << x;
    // Both ends have the noise.
    EXPECT_NEAR(width / kFrames, 0.0, narrow * std::sqrt(0.5));
    EXPECT_NEAR(width_squared / kFrames, 0.5, narrow * std::sqrt(2.0) * 0.5);
  }
}

TEST(MonoCamera, DetectsByTheHeightInThePicture) {
  MonoCameraConfig config;
  config.clutter_per_frame = 0.0;
  EXPECT_NEAR(probability_of_detection(config, config.half_detected_px), 0.5 * config.detection_probability, 1e-12);
  constexpr int kFrames = 4000;
  for (const double x : {20.0, 60.0, 72.0}) {
    int seen = 0;
    for (std::uint32_t k = 0; k < kFrames; ++k)
      seen += static_cast<int>(picture(config, {car_at(0, x, 0.0)}, k).truth.size());
    const double expected = probability_of_detection(config, config.focal_px * 1.5 / (x - 2.2));
    EXPECT_NEAR(seen / double{kFrames}, expected, 4.0 * std::sqrt(0.25 / kFrames)) << x;
  }
}

TEST(MonoCamera, ClutterAndConfusionAreAsOftenAsStated) {
  MonoCameraConfig config;
  config.clutter_per_frame = 0.7;
  config.class_confusion = 0.3;
  constexpr int kFrames = 4000;
  int clutter = 0, seen = 0, confused = 0, trucks = 0;
  for (std::uint32_t k = 0; k < kFrames; ++k) {
    const auto [boxes, truth] = picture(config, {car_at(0, 20.0, 1.0)}, k);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_LT(boxes[i].left, boxes[i].right);
      EXPECT_LT(boxes[i].top, boxes[i].bottom);
      clutter += truth[i] == kFalseBox;
      seen += truth[i] != kFalseBox;
      confused += truth[i] != kFalseBox && boxes[i].seen_as != sim::world::traffic::ObjectClass::kCar;
      trucks += truth[i] != kFalseBox && boxes[i].seen_as == sim::world::traffic::ObjectClass::kTruck;
    }
  }
  EXPECT_NEAR(clutter / double{kFrames}, 0.7, 4.0 * std::sqrt(0.7 / kFrames));
  EXPECT_NEAR(confused / double(seen), 0.3, 4.0 * std::sqrt(0.21 / seen));
  EXPECT_NEAR(trucks / double(seen), 0.06, 4.0 * std::sqrt(0.06 / seen)) << "all other classes alike";
}

TEST(MonoCamera, SeesNothingOutsideItsPictureOrBehindOthers) {
  const MonoCameraConfig config = exact_mono_camera();
  EXPECT_TRUE(picture(config, {car_at(0, 75.0, 0.0)}).truth.empty()) << "too far";
  EXPECT_TRUE(picture(config, {car_at(0, 20.0, 15.0)}).truth.empty()) << "aside";
  EXPECT_TRUE(picture(config, {car_at(0, -20.0, 0.0)}).truth.empty()) << "behind the camera";
  EXPECT_TRUE(picture(config, {car_at(0, 5.5, 0.0)}).truth.empty()) << "the picture ends above its wheels";
  EXPECT_EQ(picture(config, {car_at(0, 40.0, 0.0), car_at(1, 15.0, 0.2)}).truth, std::vector<ObjectId>{ObjectId{1}});
}

TEST(MonoCamera, LooksInItsRegionsAlone) {
  MonoCameraConfig config = exact_mono_camera();
  const std::vector<ObjectState> cars = {car_at(0, 20.0, 4.0), car_at(1, 40.0, 0.0), car_at(2, 20.0, -4.0)};
  EXPECT_EQ(picture(config, cars).truth.size(), 3U);
  EXPECT_EQ(looked_at(config), config.half_field_rad);
  config.regions[0].left = -50.0, config.regions[0].right = 50.0;
  config.region_count = 1;
  EXPECT_EQ(picture(config, cars).truth, std::vector<ObjectId>{ObjectId{1}});
  EXPECT_NEAR(looked_at(config), std::atan(50.0 / config.focal_px), 1e-12);
  config.regions[1].right = -100.0;
  config.region_count = 2;
  EXPECT_EQ(picture(config, cars).truth, (std::vector<ObjectId>{ObjectId{0}, ObjectId{1}}));
  config.clutter_per_frame = 10.0;
  for (std::uint32_t k = 0; k < 20; ++k)
    for (const MonoBox& box : picture(config, {}, k).boxes) {
      const double column = 0.5 * (box.left + box.right);
      EXPECT_TRUE(column <= -100.0 || std::abs(column) <= 50.0) << column;
    }
}

TEST(MonoCamera, KeepsAsManyBoxesAsItsListHolds) {
  MonoCameraConfig config = exact_mono_camera();
  config.max_boxes = 1;
  config.clutter_per_frame = 5.0;
  EXPECT_EQ(picture(config, {car_at(0, 20.0, 4.0), car_at(1, 40.0, 0.0)}).truth, std::vector<ObjectId>{ObjectId{0}});
}

TEST(MonoCamera, OneObjectsVisibilityNeverShiftsAnothersNoise) {
  MonoCameraConfig config;
  for (std::uint32_t k = 0; k < 20; ++k) {
    const auto both = picture(config, {car_at(0, 20.0, -5.0), car_at(1, 30.0, 5.0)}, k);
    const auto behind = picture(config, {car_at(0, -20.0, -5.0), car_at(1, 30.0, 5.0)}, k);
    const auto of_second = [](const Picture& f) {
      const auto found = std::find(f.truth.begin(), f.truth.end(), ObjectId{1});
      return found == f.truth.end() ? MonoBox{} : f.boxes[static_cast<std::size_t>(found - f.truth.begin())];
    };
    EXPECT_EQ(of_second(both).bottom, of_second(behind).bottom);
    EXPECT_EQ(of_second(both).left, of_second(behind).left);
  }
}

TEST(MonoCamera, ADriveHasOnePitch) {
  MonoCameraConfig config;
  config.pitch = {0.001, 0.002};
  double sum = 0.0, squares = 0.0;
  constexpr int kDrives = 2000;
  for (std::uint32_t drive = 0; drive < kDrives; ++drive) {
    const double pitch = in_drive(config, {1, drive, 2}).pitch.fixed;
    EXPECT_EQ(pitch, in_drive(config, {1, drive, 2}).pitch.fixed);
    sum += pitch - 0.001;
    squares += (pitch - 0.001) * (pitch - 0.001);
  }
  EXPECT_NEAR(sum / kDrives, 0.0, 4.0 * 0.002 / std::sqrt(kDrives));
  EXPECT_NEAR(squares / kDrives / 4e-6, 1.0, 4.0 * std::sqrt(2.0 / kDrives));
}

TEST(MonoCamera, TheHeightIsThatOfTheObject) {
  ObjectState lorry = car_at(0, 30.0, 0.0);
  lorry.height = 3.5;
  lorry.kind = sim::world::traffic::ObjectClass::kTruck;
  const auto [boxes, truth] = picture(exact_mono_camera(), {lorry});
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_NEAR(1.3 * (boxes[0].bottom - boxes[0].top) / boxes[0].bottom, 3.5, 1e-9);
  EXPECT_EQ(boxes[0].seen_as, sim::world::traffic::ObjectClass::kTruck);
}

TEST(MonoCamera, TheOwnVehicleHidesItsBlindSides) {
  MonoCameraConfig config = exact_mono_camera();
  config.device.blind.sectors[config.device.blind.count++] = {0.1, 0.3};
  EXPECT_EQ(picture(config, {car_at(0, 20.0, 4.0), car_at(1, 20.0, -4.0)}).truth, std::vector<ObjectId>{ObjectId{1}});
}

}  // namespace
}  // namespace ttf::sensors::mono_camera
