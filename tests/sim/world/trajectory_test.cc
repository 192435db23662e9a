#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "core/errors.h"
#include "sim/world/world.h"
#include "tests/sim/world/drives.h"

namespace ttf::sim::world {
namespace {

// Independent oracle: midpoint rule on x' = v cos h, y' = v sin h.
ObjectState integrated(ObjectState state, double dt, int steps) {
  const double h = dt / steps, v0 = state.speed, heading0 = state.heading;
  double x = 0, y = 0;
  for (int k = 0; k < steps; ++k) {
    const double t = (k + 0.5) * h;
    x += h * (v0 + state.acceleration * t) * std::cos(heading0 + state.yaw_rate * t);
    y += h * (v0 + state.acceleration * t) * std::sin(heading0 + state.yaw_rate * t);
  }
  state.x += x;
  state.y += y;
  return state;
}

ObjectState moving_car(double speed, double acceleration, double yaw_rate) {
  ObjectState state;
  state.x = 12.0;
  state.y = -3.0;
  state.heading = 0.7;
  state.speed = speed;
  state.acceleration = acceleration;
  state.yaw_rate = yaw_rate;
  return state;
}

auto values(const ObjectState& s) {
  return std::tuple(s.x, s.y, s.heading, s.speed, s.acceleration, s.yaw_rate, s.length, s.width);
}

TEST(Motion, ClosedFormAgreesWithFineIntegration) {
  for (const double yaw_rate : {0.0, 1e-9, -5e-4, 9.99e-4, 1.001e-3, 0.01, -0.3, 2.0})
    for (const double acceleration : {-3.0, 0.0, 4.0}) {
      const ObjectState start = moving_car(10.0, acceleration, yaw_rate);
      const ObjectState closed = moved(start, 1.0), fine = integrated(start, 1.0, 20000);
      EXPECT_NEAR(closed.x, fine.x, 2e-8) << yaw_rate << " rad/s, " << acceleration << " m/s^2";
      EXPECT_NEAR(closed.y, fine.y, 2e-8) << yaw_rate << " rad/s, " << acceleration << " m/s^2";
      EXPECT_DOUBLE_EQ(closed.heading, 0.7 + yaw_rate);
      EXPECT_DOUBLE_EQ(closed.speed, 10.0 + acceleration);
    }
}

TEST(Motion, TwoStepsAreOne) {
  for (const double yaw_rate : {0.0, 0.05, 0.4}) {
    const ObjectState start = moving_car(8.0, 1.5, yaw_rate);
    const ObjectState once = moved(start, 0.01), twice = moved(moved(start, 0.0037), 0.0063);
    EXPECT_NEAR(once.x, twice.x, 1e-12);
    EXPECT_NEAR(once.y, twice.y, 1e-12);
    EXPECT_NEAR(once.heading, twice.heading, 1e-15);
  }
}

TEST(Motion, AConstantTurnClosesItsCircle) {
  const ObjectState start = moving_car(5.0, 0.0, 0.5);
  const ObjectState end = moved(start, 2.0 * std::numbers::pi / 0.5);
  EXPECT_NEAR(end.x, start.x, 1e-12);
  EXPECT_NEAR(end.y, start.y, 1e-12);
  // Half way round it is a diameter (2 v / w = 20 m) to the left of its start.
  const ObjectState half = moved(start, std::numbers::pi / 0.5);
  EXPECT_NEAR(half.x, start.x - 20.0 * std::sin(0.7), 1e-12);
  EXPECT_NEAR(half.y, start.y + 20.0 * std::cos(0.7), 1e-12);
}

TEST(Motion, ABrakingCarStopsAndStays) {
  ObjectState start = moving_car(2.0, -4.0, 0.0);
  const ObjectState end = moved(start, 3.0);
  EXPECT_NEAR(std::hypot(end.x - start.x, end.y - start.y), 2.0 * 2.0 / (2.0 * 4.0), 1e-12);
  EXPECT_EQ(end.speed, 0.0);
  const ObjectState later = moved(end, 1.0);
  EXPECT_EQ(values(later), values(end));
}

TEST(Trajectory, SegmentsAreDrivenInTurnThenStraightOn) {
  WorldConfig config = world_from(
      "objects: [{name: a, x: 0, y: 0, speed: 10, segments: ["
      "{duration: 1 s, acceleration: 2}, {duration: 2 s, yaw_rate: 0.25}]}]");
  config.duration = Duration::milliseconds(5000);
  const World drive(config, 1, 0);
  const ObjectState straight = drive.state_of(ObjectId{0}, at_ms(1000));
  EXPECT_NEAR(straight.x, 11.0, 1e-9);
  EXPECT_NEAR(straight.speed, 12.0, 1e-9);
  const ObjectState turned = drive.state_of(ObjectId{0}, at_ms(3000));
  EXPECT_NEAR(turned.heading, 0.5, 1e-12);
  EXPECT_NEAR(turned.x, 11.0 + 12.0 / 0.25 * std::sin(0.5), 1e-9);
  EXPECT_NEAR(turned.y, 12.0 / 0.25 * (1.0 - std::cos(0.5)), 1e-9);
  const ObjectState after = drive.state_of(ObjectId{0}, at_ms(4237));
  EXPECT_NEAR(after.x, turned.x + 12.0 * 1.237 * std::cos(0.5), 1e-9);
  EXPECT_NEAR(after.y, turned.y + 12.0 * 1.237 * std::sin(0.5), 1e-9);
}

TEST(Trajectory, IsContinuousAcrossTheGrid) {
  const World world(drive("paper_scenario2"), 3, 0);
  for (std::int64_t step = 1; step < 300; ++step) {
    const TrueTime grid = at_ms(10 * step);
    const ObjectState before = world.state_of(ObjectId{0}, grid - Duration::nanoseconds(1));
    const ObjectState after = world.state_of(ObjectId{0}, grid);
    EXPECT_NEAR(before.x, after.x, 1e-7);
    EXPECT_NEAR(before.y, after.y, 1e-7);
    EXPECT_NEAR(before.heading, after.heading, 1e-7);
    EXPECT_NEAR(before.speed, after.speed, 1e-6);
  }
}

TEST(Trajectory, LookingInAnyOrderGivesTheSame) {
  const World world(drive("crowd_25"), 7, 2), again(drive("crowd_25"), 7, 2);
  std::vector<ObjectState> out;
  std::vector<std::vector<ObjectState>> forwards;
  for (int k = 0; k < 40; ++k) {
    world.states_at(at_ms(1511 * k), out);
    forwards.push_back(out);
  }
  const ObjectState* kept = out.data();
  for (int k = 39; k >= 0; --k) {
    again.states_at(at_ms(1511 * k), out);
    ASSERT_EQ(out.size(), 25U);
    for (std::size_t o = 0; o < out.size(); ++o) {
      EXPECT_EQ(index_of(out[o].id), o);
      EXPECT_EQ(values(out[o]), values(forwards[static_cast<std::size_t>(k)][o]));
    }
  }
  EXPECT_EQ(out.data(), kept) << "the buffer was given away";
}

TEST(Trajectory, SeedReplicationAndObjectEachDrawTheirOwn) {
  WorldConfig config = drive("paper_scenario1");
  const auto end_of = [&](std::uint64_t seed, std::uint32_t replication) {
    return values(World(config, seed, replication).state_of(ObjectId{0}, at_ms(3000)));
  };
  const auto first = end_of(1, 0);
  EXPECT_EQ(first, end_of(1, 0));
  EXPECT_NE(first, end_of(2, 0));
  EXPECT_NE(first, end_of(1, 1));
  config.objects.push_back(config.objects[0]);
  EXPECT_EQ(first, end_of(1, 0)) << "a second object changed the first one's drive";
  const World two(config, 1, 0);
  EXPECT_NE(values(two.state_of(ObjectId{1}, at_ms(3000))), first) << "two objects share their draws";
}

// White acceleration noise of sigma s in steps of T: after n steps the speed's variance is n s^2 T^2.
TEST(Trajectory, ProcessNoiseHasItsVariance) {
  WorldConfig config = world_from(
      "{acceleration_noise: 2.0, yaw_rate_noise: 0.05,"
      " objects: [{name: a, x: 0, y: 0, speed: 50}]}");
  config.duration = Duration::milliseconds(3000);
  constexpr int kRuns = 400;
  double speed = 0, speed_squared = 0, heading = 0, heading_squared = 0;
  for (std::uint32_t r = 0; r < kRuns; ++r) {
    const ObjectState end = World(config, 11, r).state_of(ObjectId{0}, at_ms(3000));
    speed += end.speed - 50.0;
    speed_squared += (end.speed - 50.0) * (end.speed - 50.0);
    heading += end.heading;
    heading_squared += end.heading * end.heading;
  }
  const double speed_sigma = 2.0 * 0.01 * std::sqrt(300.0), heading_sigma = 0.05 * 0.01 * std::sqrt(300.0);
  EXPECT_NEAR(speed / kRuns, 0.0, 4.0 * speed_sigma / std::sqrt(kRuns));
  EXPECT_NEAR(heading / kRuns, 0.0, 4.0 * heading_sigma / std::sqrt(kRuns));
  // A variance estimated from n runs spreads by sqrt(2 / n) of itself; this allows four times as much.
  const double spread = 4.0 * std::sqrt(2.0 / kRuns);
  EXPECT_NEAR(speed_squared / kRuns / (speed_sigma * speed_sigma), 1.0, spread);
  EXPECT_NEAR(heading_squared / kRuns / (heading_sigma * heading_sigma), 1.0, spread);
}

TEST(WorldFile, EveryMistakeIsFoundAtOnce) {
  try {
    world_from(
        "acceleration_noise: -1\n"
        "objects:\n"
        "  - {name: a, x: 1000, y: 0, colour: red}\n"
        "  - {x: 1, y: fast, segments: [{acceleration: 1}]}\n");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    std::vector<std::string> keys;
    for (const Finding& finding : error.findings()) {
      EXPECT_EQ(finding.file, "test.yaml");
      EXPECT_GT(finding.line, 0) << finding.sentence();
      keys.push_back(finding.key);
    }
    const auto named = [&](std::string_view part) {
      for (const std::string& key : keys)
        if (key.find(part) != std::string::npos) return true;
      return false;
    };
    for (const char* part : {"acceleration_noise", "x", "colour", "name", "y", "duration"})
      EXPECT_TRUE(named(part)) << part;
    EXPECT_EQ(keys.size(), 6U);
  }
}

TEST(WorldFile, OneCarAtMostCarriesTheReference) {
  EXPECT_NO_THROW(world_from("objects: [{name: a, x: 9, y: 0, reference: true}, {name: b, x: 20, y: 0}]"));
  EXPECT_THROW(world_from("objects: [{name: a, x: 9, y: 0, reference: true}, {name: b, x: 20, y: 0, reference: true}]"),
               InputError);
}

}  // namespace
}  // namespace ttf::sim::world
