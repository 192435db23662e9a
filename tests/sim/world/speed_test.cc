// A speed with a memory: its moments in closed form. And motion relative to a vehicle that drives, too.
#include "sim/world/speed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/sim/world/drives.h"

namespace ttf::sim::world {
namespace {

using testing::HasSubstr;

WorldConfig driven(double noise, const std::string& rest) {
  WorldConfig config = world_from("acceleration_noise: " + std::to_string(noise) + "\n" + rest +
                                  "\nobjects: [{name: a, x: 40, y: 0, speed: 50}]\n");
  config.duration = Duration::milliseconds(4000);
  return config;
}

constexpr int kRuns = 2000;

// Over kRuns drives, the mean product of deviations from 50 m/s at two instants.
double product(const WorldConfig& config, std::int64_t first_ms, std::int64_t second_ms) {
  double sum = 0.0;
  for (std::uint32_t r = 0; r < kRuns; ++r) {
    const World world(config, 17, r);
    sum += (world.state_of(ObjectId{0}, at_ms(first_ms)).speed - 50.0) *
           (world.state_of(ObjectId{0}, at_ms(second_ms)).speed - 50.0);
  }
  return sum / kRuns;
}

// With q = 4 m^2/s^3 and tau = 0.5 s:
//   variance q tau / 2 = 1,   autocorrelation exp(-s / tau)
// A mean product of n pairs spreads by at most sqrt(2 / n).
TEST(SpeedMemory, HasItsStationaryVarianceAndAutocorrelation) {
  const WorldConfig config = driven(20.0, "speed_memory: 500 ms");
  const double spread = 4.0 * std::sqrt(2.0 / kRuns);
  for (const std::int64_t at : {0, 300, 4000}) EXPECT_NEAR(product(config, at, at), 1.0, spread) << at;
  for (const std::int64_t later : {100, 500, 1200})
    EXPECT_NEAR(product(config, 1000, 1000 + later), std::exp(-1e-3 * static_cast<double>(later) / 0.5), spread)
        << later;
}

// The way is the integral of the speed. With s^2 as the speed's variance, that of the way is:
//   2 s^2 tau (t - tau (1 - exp(-t / tau)))
TEST(SpeedMemory, TheWaySpreadsAsTheIntegral) {
  const WorldConfig config = driven(20.0, "speed_memory: 500 ms");
  double squares = 0.0;
  for (std::uint32_t r = 0; r < kRuns; ++r) {
    const double way = World(config, 18, r).state_of(ObjectId{0}, at_ms(3000)).x - 40.0 - 150.0;
    squares += way * way;
  }
  const double variance = 2.0 * 1.0 * 0.5 * (3.0 - 0.5 * (1.0 - std::exp(-6.0)));
  EXPECT_NEAR(squares / kRuns / variance, 1.0, 4.0 * std::sqrt(2.0 / kRuns));
}

// A long memory adds the noise up.
TEST(SpeedMemory, ALongOneIsNone) {
  WorldConfig with = driven(2.0, "speed_memory: 3600 s"), without = driven(2.0, "");
  for (std::uint32_t r = 0; r < 20; ++r) {
    const World a(with, 3, r), b(without, 3, r);
    const double start = a.state_of(ObjectId{0}, at_ms(0)).speed;
    for (const std::int64_t at : {10, 1000, 4000})
      EXPECT_NEAR(a.state_of(ObjectId{0}, at_ms(at)).speed - start, b.state_of(ObjectId{0}, at_ms(at)).speed - 50.0,
                  0.02 * std::abs(start - 50.0) + 1e-3);
  }
}

// The acceleration without white noise: the segments', and the return to them. Noise of 5 m/s^2 leaves it alone where there
// is no memory. With one it is what the next second loses of the deviation, on the average over draws.
TEST(SpeedMemory, ASteadyAccelerationHasNoWhiteNoise) {
  const std::string car =
      "objects: [{name: a, x: 0, y: 0, speed: 30, segments: [{duration: 2 s, acceleration: -4}]}]\n";
  WorldConfig config = world_from("acceleration_noise: 5\n" + car);
  config.duration = Duration::milliseconds(4000);
  const World without(config, 4, 0);
  EXPECT_EQ(without.state_of(ObjectId{0}, at_ms(1500)).steady, -4.0);
  EXPECT_EQ(without.state_of(ObjectId{0}, at_ms(2500)).steady, 0.0);
  EXPECT_NE(without.state_of(ObjectId{0}, at_ms(1500)).acceleration, -4.0);
  config = world_from("acceleration_noise: 5\nspeed_memory: 200 ms\n" + car);
  config.duration = Duration::milliseconds(4000);
  for (std::uint32_t r = 0; r < 20; ++r) {
    const ObjectState state = World(config, 4, r).state_of(ObjectId{0}, at_ms(3000));
    EXPECT_NEAR(state.steady, (22.0 - state.speed) / 0.2, 1e-9);
  }
}

TEST(SpeedMemory, AStandingCarHasNoSteadyBraking) {
  WorldConfig config =
      world_from("objects: [{name: a, x: 0, y: 0, speed: 2, segments: [{duration: 4 s, acceleration: -1}]}]\n");
  config.duration = Duration::milliseconds(4000);
  const World world(config, 1, 0);
  EXPECT_EQ(world.state_of(ObjectId{0}, at_ms(1000)).steady, -1.0);
  EXPECT_EQ(world.state_of(ObjectId{0}, at_ms(3000)).steady, 0.0);
}

TEST(SpeedMemory, FollowsTheSegments) {
  WorldConfig config = world_from(
      "acceleration_noise: 5\nspeed_memory: 200 ms\n"
      "objects: [{name: a, x: 0, y: 0, speed: 30, segments: [{duration: 2 s, acceleration: -4}]}]\n");
  config.duration = Duration::milliseconds(4000);
  double speed = 0.0;
  for (std::uint32_t r = 0; r < 400; ++r) speed += World(config, 4, r).state_of(ObjectId{0}, at_ms(3500)).speed / 400.0;
  // Its standard deviation is sqrt(0.25 * 0.2 / 2) = 0.158 m/s.
  EXPECT_NEAR(speed, 22.0, 4.0 * 0.158 / std::sqrt(400.0));
}

// A wish below 0 leaves the car standing, and it drives on when it wishes to.
TEST(SpeedMemory, ACarStopsAndDrivesOn) {
  WorldConfig config =
      world_from("acceleration_noise: 50\nspeed_memory: 500 ms\nobjects: [{name: a, x: 0, y: 0, speed: 1}]\n");
  config.duration = Duration::milliseconds(20'000);
  const World world(config, 6, 0);
  int standing = 0, leaving = 0;
  double before = 0.0, x = 0.0;
  for (std::int64_t at = 10; at <= 20'000; at += 10) {
    const ObjectState state = world.state_of(ObjectId{0}, at_ms(at));
    EXPECT_GE(state.speed, 0.0);
    EXPECT_GE(state.x, x);
    standing += state.speed == 0.0;
    leaving += before == 0.0 && state.speed > 0.0;
    before = state.speed;
    x = state.x;
  }
  EXPECT_GT(standing, 100);
  EXPECT_GT(leaving, 5);
}

TEST(OwnSpeed, MakesMotionRelative) {
  const WorldConfig over_ground = driven(20.0, "speed_memory: 500 ms");
  WorldConfig relative = over_ground;
  relative.own_speed = 50.0;
  const World a(over_ground, 9, 3), b(relative, 9, 3);
  bool falls_back = false;
  for (const std::int64_t at : {0, 5, 10, 1733, 4000}) {
    const ObjectState ground = a.state_of(ObjectId{0}, at_ms(at)), seen = b.state_of(ObjectId{0}, at_ms(at));
    EXPECT_NEAR(seen.x, ground.x - 50e-3 * static_cast<double>(at), 1e-9);
    EXPECT_NEAR(seen.speed, ground.speed - 50.0, 1e-9);
    EXPECT_EQ(seen.acceleration, ground.acceleration);
  }
  for (std::int64_t at = 0; at < 4000; at += 10) falls_back |= b.state_of(ObjectId{0}, at_ms(at)).speed < 0.0;
  EXPECT_TRUE(falls_back) << "a relative speed is not stopped at 0";
}

TEST(OwnSpeed, NeedsObjectsThatDriveAlongX) {
  for (const char* rest :
       {"yaw_rate_noise: 0.1\nobjects: [{name: a, x: 9, y: 0}]", "objects: [{name: a, x: 9, y: 0, heading: 1}]",
        "objects: [{name: a, x: 9, y: 0, segments: [{duration: 1 s, yaw_rate: 0.1}]}]",
        "field: {objects: 1, heading: 0.1}"})
    try {
      world_from(std::string("own_speed: 10\n") + rest);
      FAIL() << rest;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("own_speed = 10: must be 0, since an object turns or does not head along x"));
    }
  EXPECT_NO_THROW(world_from("own_speed: 10\nobjects: [{name: a, x: 9, y: 0}]"));
}

}  // namespace
}  // namespace ttf::sim::world
