// A wall, poles and bushes are no vehicles. A vehicle in pieces is one, and two side by side are two.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sensors/laser/preprocessor.h"
#include "tests/sensors/laser/emulated_scan.h"
#include "tests/sensors/laser/hand_made_scan.h"

namespace ttf::sensors::laser {
namespace {

constexpr int kHandMadeScans = 40;

LaserPreprocessingConfig without_shapes() {
  LaserPreprocessingConfig config;
  config.parts.join_gap_m = config.parts.split_step_m = 0.0;
  config.shape = {.thinnest_m = 0.0, .roughest_m = 1e9};
  return config;
}

std::vector<LaserObject> objects_in(LaserPreprocessor& preprocessor, const std::vector<ScanPoint>& scan) {
  std::vector<LaserObject> objects;
  preprocessor.process(scan, objects);
  return objects;
}

TEST(HandMadeScans, AWallIsAnOutlineAndNoObject) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  for (int k = 0; k < kHandMadeScans; ++k) {
    EXPECT_TRUE(objects_in(preprocessor, hand_made_scan({{15, -12, 15, 12}}, static_cast<std::uint64_t>(k))).empty());
    EXPECT_EQ(preprocessor.fates().large, 1U);
    ASSERT_EQ(preprocessor.outlines().size(), 1U);
    EXPECT_GT(preprocessor.outlines()[0].size(), 300U);
  }
}

TEST(HandMadeScans, PolesAreTooThin) {
  LaserPreprocessor preprocessor({}, kMostPoints), before(without_shapes(), kMostPoints);
  for (int k = 0; k < kHandMadeScans; ++k) {
    const double range = 4.0 + 0.2 * k;
    const auto scan = hand_made_scan(drawn_circle(range, 0.02 * k, 0.15), static_cast<std::uint64_t>(k));
    EXPECT_TRUE(objects_in(preprocessor, scan).empty()) << "at " << range << " m";
    EXPECT_EQ(preprocessor.fates().thin, 1U) << "at " << range << " m";
    EXPECT_EQ(preprocessor.outlines().size(), 1U);
    EXPECT_EQ(objects_in(before, scan).size(), 1U);
  }
}

TEST(HandMadeScans, BushesAreTooRough) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  int rough = 0, vehicles = 0;
  for (int k = 0; k < kHandMadeScans; ++k) {
    const auto scan = hand_made_scan(drawn_circle(9.0, 1.0, 1.2), static_cast<std::uint64_t>(k), 0.02, 1.2);
    for (const LaserObject& o : objects_in(preprocessor, scan)) vehicles += o.shape == VehicleShape::kVehicle;
    rough += preprocessor.fates().rough > 0;
  }
  EXPECT_GT(rough, kHandMadeScans / 2);
  EXPECT_LT(vehicles, kHandMadeScans / 10) << "by chance";
}

TEST(HandMadeScans, ACarIsAVehicleFromAllSides) {
  LaserPreprocessor preprocessor({}, kMostPoints), before(without_shapes(), kMostPoints);
  int vehicles = 0;
  for (int k = 0; k < kHandMadeScans; ++k) {
    const auto scan = hand_made_scan(drawn_box(14.0, 3.0, 0.16 * k), static_cast<std::uint64_t>(k));
    const auto objects = objects_in(preprocessor, scan);
    ASSERT_EQ(objects.size(), 1U) << k;
    EXPECT_TRUE(preprocessor.outlines().empty());
    vehicles += objects[0].shape == VehicleShape::kVehicle;
    EXPECT_EQ(objects[0].x, objects_in(before, scan).at(0).x);
  }
  EXPECT_EQ(vehicles, kHandMadeScans);
}

TEST(HandMadeScans, ACarThatIsAlmostHiddenIsNoPole) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  for (int k = 0; k < kHandMadeScans; ++k) {
    // The near car leaves 0.3 m of the far rear in view, which is 1.8 m wide.
    const auto scan = hand_made_scan(drawn_box(26.2, 0, 0) + drawn_box(14.2, -0.65, 0), static_cast<std::uint64_t>(k));
    const auto objects = objects_in(preprocessor, scan);
    ASSERT_EQ(objects.size(), 2U) << k;
    EXPECT_EQ(objects[1].shape, VehicleShape::kPart);
    EXPECT_EQ(preprocessor.fates().thin, 0U);
  }
}

// Seen from the origin, a side along y = 8 from x = 8 to 12.4. Its glass, 1 m long, returns nothing.
TEST(HandMadeScans, AVehicleInPiecesIsOne) {
  const std::vector<DrawnLine> side = {{8, 8, 9.0, 8}, {9.0, 8, 10.0, 8, true}, {10.0, 8, 12.4, 8}};
  LaserPreprocessor preprocessor({}, kMostPoints), before(without_shapes(), kMostPoints);
  for (int k = 0; k < kHandMadeScans; ++k) {
    const auto scan = hand_made_scan(side, static_cast<std::uint64_t>(k));
    const auto objects = objects_in(preprocessor, scan);
    ASSERT_EQ(objects.size(), 1U) << k;
    EXPECT_TRUE(objects[0].has_length);
    EXPECT_NEAR(objects[0].length, 4.4, 0.25);
    EXPECT_EQ(objects_in(before, scan).size(), 2U);
  }
}

TEST(HandMadeScans, TwoEndsSideBySideAreNotJoined) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  for (int k = 0; k < kHandMadeScans; ++k) {
    const auto scan = hand_made_scan(drawn_box(14.2, -1.4, 0) + drawn_box(14.2, 1.4, 0), static_cast<std::uint64_t>(k));
    EXPECT_EQ(objects_in(preprocessor, scan).size(), 2U) << "1 m between them";
  }
}

TEST(HandMadeScans, TwoVehiclesThatTouchAreSplitAtTheStep) {
  LaserPreprocessor preprocessor({}, kMostPoints), before(without_shapes(), kMostPoints);
  for (int k = 0; k < kHandMadeScans; ++k) {
    // Rears at 12.0 m and at 12.5 m, and 0.1 m between the cars.
    const auto scan =
        hand_made_scan(drawn_box(14.2, -0.95, 0) + drawn_box(14.7, 0.95, 0), static_cast<std::uint64_t>(k));
    const auto objects = objects_in(preprocessor, scan);
    ASSERT_EQ(objects.size(), 2U) << k;
    EXPECT_NEAR(objects[0].y, -1.0, 0.3);
    EXPECT_NEAR(objects[1].y, 1.0, 0.3);
    EXPECT_EQ(objects_in(before, scan).size(), 1U);
  }
}

// Preprocessing does to emulated cars what it did without these rules, in all but one of a thousand.
TEST(HandMadeScans, EmulatedCarsAreAsWithoutShapes) {
  LaserPreprocessor preprocessor({}, kMostPoints), before(without_shapes(), kMostPoints);
  RandomStream stream({.seed = 7});
  std::size_t compared = 0, different = 0;
  for (std::uint32_t k = 0; k < 300; ++k) {
    std::vector<sim::world::ObjectState> cars;
    for (std::uint16_t lane = 0; lane < 4; ++lane)
      for (std::uint16_t row = 0; row < 3; ++row) {
        const double x = 12.0 + 25.0 * row + 8.0 * stream.normal() / 3.0;
        const double heading = 0.05 * stream.normal();
        cars.push_back(car_at(x, 3.5 * lane - 5.25, heading, 4.4, 1.8, static_cast<std::uint16_t>(3 * lane + row)));
      }
    const auto scan = emulated_scan({}, cars, k);
    const auto now = objects_in(preprocessor, scan), then = objects_in(before, scan);
    compared += then.size();
    if (now.size() != then.size()) {
      ++different;
      continue;
    }
    for (std::size_t i = 0; i < now.size(); ++i) different += now[i].x != then[i].x || now[i].seen != then[i].seen;
  }
  EXPECT_GT(compared, 1500U);
  EXPECT_LE(different, compared / 1000);
}

}  // namespace
}  // namespace ttf::sensors::laser
