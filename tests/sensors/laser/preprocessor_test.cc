#include "sensors/laser/preprocessor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/errors.h"
#include "tests/sensors/laser/emulated_scan.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sensors::laser {
namespace {

using ttf::fusion::sensors::SeenPoint;

std::vector<sim::world::ObjectState> fan() {
  std::vector<sim::world::ObjectState> cars;
  for (int k = 0; k < 12; ++k) {
    const double azimuth = 0.072 * (k - 5.5), range = k % 2 == 0 ? 35.0 : 22.0;
    cars.push_back(
        car_at(range * std::cos(azimuth), range * std::sin(azimuth), azimuth, 4.4, 1.8, static_cast<std::uint16_t>(k)));
  }
  return cars;
}

TEST(LaserPreprocessor, FindsEachCarOnce) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  const std::vector<sim::world::ObjectState> cars = {car_at(20.0, -6.0, 0.0), car_at(35.0, 0.0, 0.3, 4.4, 1.8, 1),
                                                     car_at(15.0, 6.0, std::numbers::pi / 2, 4.4, 1.8, 2)};
  std::vector<LaserObject> objects;
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
    preprocessor.process(emulated_scan({}, cars, sequence), objects);
    ASSERT_EQ(objects.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(std::hypot(objects[i].x - cars[i].x, objects[i].y - cars[i].y), 2.5) << "car " << i;
    EXPECT_LT(objects[0].y / objects[0].x, objects[1].y / objects[1].x) << "not from right to left";
  }
}

TEST(LaserPreprocessor, WallsAndSpecksAreNoObjects) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  std::vector<LaserObject> objects(3);
  const std::vector<ScanPoint> specks = {{0, -0.3, 30.0}, {1, -0.3, 30.05}, {2, 0.2, 12.0}};
  preprocessor.process(specks, objects);
  EXPECT_TRUE(objects.empty()) << "two returns are fewer than fewest_points; the list is replaced";
  EXPECT_EQ(preprocessor.fates().small, 2U);
  EXPECT_EQ(preprocessor.fates().segments(), 2U);
  preprocessor.process(emulated_scan({}, {car_at(20.0, 0.0, 0.0, 1.0, 25.0)}, 0), objects);
  EXPECT_TRUE(objects.empty()) << "a wall of 25 m";
  EXPECT_EQ(preprocessor.fates().large, 1U);
  EXPECT_EQ(preprocessor.fates().objects, 0U);
  EXPECT_EQ(preprocessor.outlines().size(), 1U);
  preprocessor.process({}, objects);
  EXPECT_TRUE(objects.empty() && preprocessor.outlines().empty());
}

TEST(LaserPreprocessor, SameScanSameBits) {
  LaserPreprocessor used({}, kMostPoints), fresh({}, kMostPoints);
  std::vector<LaserObject> first, second;
  for (std::uint32_t sequence = 0; sequence < 5; ++sequence) used.process(emulated_scan({}, fan(), sequence), first);
  fresh.process(emulated_scan({}, fan(), 4), second);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].x, second[i].x);
    EXPECT_EQ(first[i].syy, second[i].syy);
    EXPECT_EQ(first[i].heading, second[i].heading);
  }
}

// A scan of returns in groups, each far from the next. Groups of one give the most segments; groups of an
// object's fewest returns give the most objects.
std::vector<ScanPoint> broken_scan(std::size_t group) {
  std::vector<ScanPoint> scan;
  for (std::size_t i = 0; i < kMostPoints; ++i)
    scan.push_back({0, -2.8 + 0.00436 * static_cast<double>(i), (i / group) % 2 == 0 ? 20.0 : 30.0});
  return scan;
}

TEST(LaserPreprocessor, DoesNotAllocate) {
  LaserPreprocessingConfig config;
  config.shape.thinnest_m = 0.0;  // the groups below are thin
  LaserPreprocessor preprocessor(config, kMostPoints);
  std::vector<std::vector<ScanPoint>> scans;
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) scans.push_back(emulated_scan({}, fan(), sequence));
  const auto single = broken_scan(1), triple = broken_scan(3);
  std::vector<LaserObject> objects;
  objects.reserve(preprocessor.most_objects());
  const std::int64_t before = support::allocations();
  for (const auto& scan : scans) preprocessor.process(scan, objects);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_GE(objects.size(), 10U);
  preprocessor.process(single, objects);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_TRUE(objects.empty());
  preprocessor.process(triple, objects);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_EQ(objects.size(), preprocessor.most_objects());
}

// A car at 20 m, and one at 10 m that covers part of its rear.
TEST(LaserPreprocessor, AnEndBehindANearerObjectIsNoEndOfAFace) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  const auto rear = car_at(22.2, 0.0, 0.0), side = car_at(20.0, 0.0, std::numbers::pi / 2, 4.4, 1.8);
  std::vector<LaserObject> objects;
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
    preprocessor.process(emulated_scan({}, {rear}, sequence), objects);
    ASSERT_EQ(objects.size(), 1U);
    EXPECT_EQ(objects[0].seen, SeenPoint::kEnd);
    for (const double y : {-1.1, 1.1}) {
      preprocessor.process(emulated_scan({}, {rear, car_at(12.2, y, 0.0, 4.4, 1.8, 1)}, sequence), objects);
      ASSERT_EQ(objects.size(), 2U);
      const LaserObject& far = objects[0].x > objects[1].x ? objects[0] : objects[1];
      EXPECT_EQ(far.seen, SeenPoint::kSilhouette) << "0.4 m of 1.8 m are hidden at " << y;
      EXPECT_FALSE(far.has_heading || far.has_length || far.has_width);
      preprocessor.process(emulated_scan({}, {side, car_at(12.2, y, 0.0, 4.4, 1.8, 1)}, sequence), objects);
      for (const LaserObject& o : objects)
        EXPECT_TRUE(o.x < 15.0 || !o.has_length) << "part of a side is hidden at " << y;
    }
  }
}

// The list has no room for the left part of a side.
TEST(LaserPreprocessor, AScanThatIsNotWholeCutsItsLastObject) {
  LaserPreprocessor preprocessor({}, kMostPoints);
  std::vector<ScanPoint> scan = emulated_scan({}, {car_at(20.0, 0.0, std::numbers::pi / 2, 10.0, 2.5)}, 0);
  std::vector<LaserObject> objects;
  preprocessor.process(scan, objects);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].seen, SeenPoint::kSide);
  EXPECT_NEAR(objects[0].length, 10.0, 0.3);
  scan.resize(scan.size() / 2);
  preprocessor.process(scan, objects, false);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].seen, SeenPoint::kRightmost);
  EXPECT_FALSE(objects[0].has_length);
  preprocessor.process(scan, objects);
  EXPECT_EQ(objects[0].seen, SeenPoint::kSide) << "if nothing says that the scan is not whole";
}

// The field ends in the middle of a rear 30 m away: its free end is reported.
TEST(LaserPreprocessor, AnOutlineThatTheFieldCutsHasAFreeEnd) {
  const std::vector<sim::world::ObjectState> cars = {car_at(30.0 * std::cos(1.05), 30.0 * std::sin(1.05), 1.05)};
  std::vector<LaserObject> objects;
  LaserPreprocessor({}, kMostPoints).process(emulated_scan({}, cars, 0), objects);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].seen, SeenPoint::kRightmost);
  LaserPreprocessingConfig config;
  config.free_ends = false;
  LaserPreprocessor leaves_out(config, kMostPoints);
  leaves_out.process(emulated_scan({}, cars, 0), objects);
  EXPECT_TRUE(objects.empty());
  EXPECT_EQ(leaves_out.fates().cut, 1U);
}

// A nearer car hides a part of a rear.
TEST(LaserPreprocessor, ASilhouetteThatIsCutMayBeLeftOut) {
  LaserPreprocessingConfig config;
  const std::vector<sim::world::ObjectState> cars = {car_at(22.2, 0.0, 0.0), car_at(12.2, 1.1, 0.0, 4.4, 1.8, 1)};
  std::vector<LaserObject> objects;
  LaserPreprocessor(config, kMostPoints).process(emulated_scan({}, cars, 0), objects);
  EXPECT_EQ(objects.size(), 2U);
  config.cut_silhouettes = false;
  LaserPreprocessor leaves_out(config, kMostPoints);
  leaves_out.process(emulated_scan({}, cars, 0), objects);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_LT(objects[0].x, 15.0);
  EXPECT_EQ(leaves_out.fates().cut, 1U);
}

TEST(LaserPreprocessor, KeysOfEarlierVersionsSayWhereTheyWent) {
  for (const char* key : {"nominal_length", "length_sigma", "nominal_width", "width_sigma"}) {
    const StrictYaml yaml = StrictYaml::parse(std::string("{") + key + ": 1}", "test.yaml");
    Findings findings;
    YamlMap root = yaml.root(findings);
    load_laser_preprocessing(root);
    root.finish();
    ASSERT_EQ(findings.size(), 1U) << key;
    try {
      findings.throw_if_any();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("the tracker knows"), std::string::npos) << error.what();
    }
  }
}

TEST(LaserPreprocessor, ItsKeysAreChecked) {
  const StrictYaml yaml = StrictYaml::parse("{range_noise: -1, fewest_points: 4, colour: red}", "test.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  const LaserPreprocessingConfig config = load_laser_preprocessing(root);
  root.finish();
  EXPECT_EQ(config.fewest_points, 4);
  EXPECT_EQ(findings.size(), 2U);
}

}  // namespace
}  // namespace ttf::sensors::laser
