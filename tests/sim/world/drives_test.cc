// The shipped drives match their descriptions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sensors/laser/model.h"
#include "sensors/stereo_camera/model.h"
#include "tests/sim/world/drives.h"

namespace ttf::sim::world {
namespace {

TEST(PaperScenario1, TheCarGoesFrom30To40Metres) {
  const World world(without_noise(drive("paper_scenario1")), 1, 0);
  const ObjectState from = world.state_of(ObjectId{0}, at_ms(1500)), to = world.state_of(ObjectId{0}, at_ms(3000));
  EXPECT_NEAR(from.x, 30.0, 0.01);
  EXPECT_NEAR(to.x, 40.0, 0.01);
  EXPECT_EQ(from.y, 0.0);
  EXPECT_EQ(to.y, 0.0);
  EXPECT_GT(to.speed, from.speed);
}

TEST(PaperScenario1, ProcessNoiseLeavesItTheSameDrive) {
  const WorldConfig config = drive("paper_scenario1");
  EXPECT_GT(config.acceleration_noise, 0.0);
  for (std::uint32_t r = 0; r < 50; ++r) {
    const World world(config, 1, r);
    EXPECT_NEAR(world.state_of(ObjectId{0}, at_ms(1500)).x, 30.0, 1.5);
    EXPECT_NEAR(world.state_of(ObjectId{0}, at_ms(3000)).x, 40.0, 3.0);
  }
}

TEST(PaperScenario2, TheCarApproachesAtConstantSpeedAndTurnsAt20Metres) {
  const World world(without_noise(drive("paper_scenario2")), 1, 0);
  double last_x = 1e9, turned_at = 0.0;
  const double y = world.state_of(ObjectId{0}, at_ms(0)).y, speed = world.state_of(ObjectId{0}, at_ms(0)).speed;
  for (std::int64_t ms = 0; ms <= 3000; ms += 10) {
    const ObjectState car = world.state_of(ObjectId{0}, at_ms(ms));
    EXPECT_LT(car.x, last_x);
    last_x = car.x;
    if (turned_at == 0.0 && car.yaw_rate != 0.0) turned_at = car.x;
    if (turned_at == 0.0) {
      EXPECT_NEAR(car.y, y, 1e-6);
      EXPECT_NEAR(car.speed, speed, 1e-12);
    }
  }
  EXPECT_NEAR(turned_at, 20.0, 0.5);
  const ObjectState end = world.state_of(ObjectId{0}, at_ms(3000));
  EXPECT_GT(std::abs(end.heading - std::numbers::pi), 0.4) << "hardly a turn";
  EXPECT_GT(std::abs(end.y - y), 0.8) << "significant movement in both directions";
}

TEST(PaperDrives, OneCarCarriesTheReference) {
  for (const char* name : {"paper_scenario1", "paper_scenario2"}) {
    const WorldConfig config = drive(name);
    EXPECT_EQ(std::count_if(config.objects.begin(), config.objects.end(), [](const auto& o) { return o.reference; }),
              1);
  }
}

TEST(Crowd25, EveryObjectStaysInRangeAndInViewOfBothSensorsForAMinute) {
  const WorldConfig config = drive("crowd_25");
  ASSERT_EQ(config.objects.size(), 25U);
  ASSERT_EQ(config.duration, Duration::milliseconds(60'000));
  sensors::stereo_camera::CameraConfig camera;
  camera.miss_probability = camera.clutter_per_frame = 0.0;
  const sensors::laser::LaserConfig laser;
  std::vector<ObjectState> states;
  std::vector<sensors::laser::HitPoint> hits;
  sensors::stereo_camera::CameraRoom room(25);
  std::vector<sensors::stereo_camera::CameraDetection> detections;
  std::vector<ObjectId> laser_truth, camera_truth;
  std::vector<int> seen(25, 0);
  constexpr int kDrives = 4, kLooks = 61;
  std::vector<World> worlds;
  for (std::uint32_t r = 0; r < kDrives; ++r) worlds.emplace_back(config, 1, r);
  for (int look = 0; look < kDrives * kLooks; ++look) {
    const int k = look % kLooks;
    worlds[static_cast<std::size_t>(look / kLooks)].states_at(at_ms(1000 * k), states);
    sensors::laser::measure_laser(laser, states, {1, 0, 0, static_cast<std::uint32_t>(k)}, hits, laser_truth);
    sensors::stereo_camera::measure_camera(camera, states, {1, 0, 1, static_cast<std::uint32_t>(k)}, room, detections,
                                           camera_truth);
    EXPECT_LE(hits.size(), 1300U);
    EXPECT_EQ(camera_truth.size(), 25U) << "hidden or out of view at " << k << " s";
    for (const ObjectState& state : states) {
      const double range = std::hypot(state.x, state.y);
      EXPECT_GT(range, 10.0);
      EXPECT_LT(range, 80.0);
      seen[index_of(state.id)] += std::count(laser_truth.begin(), laser_truth.end(), state.id) >= 3;
    }
  }
  for (const int looks : seen) EXPECT_EQ(looks, kDrives * kLooks) << "too few returns";
}

}  // namespace
}  // namespace ttf::sim::world
