// The sensors' vehicle in the world: its way, and the objects that it sees from there.
#include "sim/world/ego.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sensors/scene.h"
#include "tests/sim/world/drives.h"
#include "tests/support/refusals.h"

namespace ttf::sim::world {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;

WorldConfig with_ego(const std::string& ego, const std::string& objects = "") {
  WorldConfig config = world_from("ego: " + ego + "\nobjects: [" + objects + "]");
  config.duration = Duration::milliseconds(10'000);
  return config;
}

std::string sentence_about(const std::string& text) {
  return support::refusal_of([&] { world_from(text); });
}

std::vector<Finding> sentences_about(const std::string& text) {
  return support::findings_of([&] { world_from(text); });
}

TEST(Ego, StandsAtTheOriginUnlessItDrives) {
  const World world(world_from("own_speed: 5\nobjects: [{name: a, x: 9, y: 0}]"), 1, 0);
  EXPECT_EQ(world.ego_at(at_ms(500)).x, 0.0);
  EXPECT_EQ(world.ego_at(at_ms(500)).vx, 0.0);
}

TEST(Ego, DrivesItsProfile) {
  const World world(with_ego("{start: {x: 3, y: 1, heading: 0.5, speed: 10}, profile: [{duration: 1 s},"
                             "{duration: 2 s, acceleration: -2}, {duration: 1 s, speed: 8, acceleration: 4}]}"),
                    1, 0);
  const EgoState one = world.ego_at(at_ms(1000)), three = world.ego_at(at_ms(3000)), end = world.ego_at(at_ms(9000));
  EXPECT_NEAR(one.x, 3.0 + 10.0 * std::cos(0.5), 1e-9);
  EXPECT_NEAR(one.y, 1.0 + 10.0 * std::sin(0.5), 1e-9);
  EXPECT_NEAR(three.vx, 6.0, 1e-9);
  EXPECT_NEAR(world.ego_at(at_ms(2000)).acceleration, -2.0, 1e-12);
  EXPECT_NEAR(world.ego_at(at_ms(3250)).vx, 7.0, 1e-9);
  EXPECT_NEAR(end.vx, 8.0, 1e-9);
  EXPECT_NEAR(end.acceleration, 0.0, 1e-9);
  EXPECT_EQ(end.yaw_rate, 0.0);
}

TEST(Ego, StopsAndStands) {
  const World world(with_ego("{start: {speed: 5}, profile: [{duration: 8 s, acceleration: -3, steering: 0.1}]}"), 1, 0);
  const EgoState stopped = world.ego_at(at_ms(1700)), later = world.ego_at(at_ms(7000));
  EXPECT_NEAR(stopped.vx, 0.0, 1e-9);
  EXPECT_EQ(later.vx, 0.0);
  EXPECT_EQ(later.yaw_rate, 0.0);
  EXPECT_NEAR(std::hypot(later.x - stopped.x, later.y - stopped.y), 0.0, 1e-9);
  EXPECT_NEAR(std::hypot(later.x, later.y), 25.0 / 6.0, 0.05);
}

// A circle of 25 m radius, by both models.
TEST(Ego, TurnsAtItsYawRate) {
  for (const char* model : {"kinematic", "single_track"}) {
    const World world(with_ego(std::string("{vehicle: {model: ") + model +
                               "}, start: {speed: 10}, profile: [{duration: 10 s, yaw_rate: 0.4}]}"),
                      1, 0);
    const EgoState a = world.ego_at(at_ms(2000)), b = world.ego_at(at_ms(2000 + 2500));
    EXPECT_NEAR(a.yaw_rate, 0.4, 2e-3) << model;
    EXPECT_NEAR(b.heading - a.heading, 1.0, 5e-3) << model;
    EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y), 2.0 * 25.0 * std::sin(0.5), 0.1) << model;
  }
}

TEST(Ego, MovesAsItsVelocitySays) {
  const World world(
      with_ego("{start: {speed: 9, heading: 0.3}, profile: [{duration: 3 s, yaw_rate: 0.5, acceleration: -1.5},"
               "{duration: 4 s, steering: -0.2, speed: 12}]}"),
      1, 0);
  constexpr std::int64_t kNear = 100'000;  // ns
  for (std::int64_t ms = 5; ms < 9000; ms += 137) {
    const TrueTime at = at_ms(ms);
    const EgoState s = world.ego_at(at), before = world.ego_at(at - Duration{kNear}),
                   after = world.ego_at(at + Duration{kNear});
    const double dt = 2e-9 * kNear, c = std::cos(s.heading), n = std::sin(s.heading);
    const double x = (after.x - before.x) / dt, y = (after.y - before.y) / dt;
    EXPECT_NEAR(c * x + n * y, s.vx, 2e-3) << ms;
    EXPECT_NEAR(c * y - n * x, s.vy, 2e-3) << ms;
    EXPECT_NEAR((after.heading - before.heading) / dt, s.yaw_rate, 1e-4) << ms;
    EXPECT_NEAR((after.vx - before.vx) / dt, s.acceleration, 1e-3) << ms;
  }
}

TEST(Ego, IsTheSameInAnyOrderOfLooks) {
  const WorldConfig config = with_ego("{start: {speed: 9}, profile: [{duration: 3 s, yaw_rate: 0.5}]}");
  const World a(config, 1, 0), b(config, 2, 7);
  for (std::int64_t ms = 9999; ms >= 0; ms -= 101) a.ego_at(at_ms(ms));
  for (std::int64_t ms = 0; ms < 9999; ms += 101) {
    EXPECT_EQ(a.ego_at(at_ms(ms)).x, b.ego_at(at_ms(ms)).x);
    EXPECT_EQ(a.ego_at(at_ms(ms)).yaw_rate, b.ego_at(at_ms(ms)).yaw_rate);
  }
}

// Objects seen from the vehicle and put back on the ground are where they are without it.
TEST(Ego, SeesObjectsInItsAxes) {
  const std::string objects =
      "{name: a, x: 30, y: 5, heading: 1, speed: 4, segments: [{duration: 5 s, yaw_rate: 0.3}]},"
      "{name: b, x: 20, y: -8, heading: -3}";
  const WorldConfig config = with_ego("{start: {x: 2, speed: 9}, profile: [{duration: 9 s, yaw_rate: 0.7}]}", objects);
  WorldConfig ground = config;
  ground.ego.reset();
  const World from(config, 3, 0), over(ground, 3, 0);
  std::vector<ObjectState> seen;
  for (std::int64_t ms = 0; ms < 9000; ms += 333) {
    const EgoState ego = from.ego_at(at_ms(ms));
    from.states_at(at_ms(ms), seen);
    for (const ObjectState& s : seen) {
      const ObjectState is = over.state_of(s.id, at_ms(ms)), one = from.state_of(s.id, at_ms(ms));
      EXPECT_EQ(one.x, s.x);
      EXPECT_NEAR(ego.x + std::cos(ego.heading) * s.x - std::sin(ego.heading) * s.y, is.x, 1e-9);
      EXPECT_NEAR(ego.y + std::sin(ego.heading) * s.x + std::cos(ego.heading) * s.y, is.y, 1e-9);
      EXPECT_NEAR(std::remainder(ego.heading + s.heading - is.heading, 2.0 * kPi), 0.0, 1e-9);
      EXPECT_LE(std::abs(s.heading), kPi);
      EXPECT_EQ(s.speed, is.speed);
      EXPECT_EQ(s.acceleration, is.acceleration);
      EXPECT_EQ(s.yaw_rate, is.yaw_rate);
    }
  }
  const sensors::WorldScene scene(config, 3, 0, TrueTime{} + Duration::milliseconds(250));
  EXPECT_EQ(scene.ego_at(at_ms(1250)).x, from.ego_at(at_ms(1000)).x);
}

TEST(Ego, RefusesWhatContradictsIt) {
  EXPECT_THAT(sentence_about("own_speed: 5\nego: {}\nobjects: []"),
              HasSubstr("own_speed = 5: must be 0 or absent beside an ego"));
  EXPECT_THAT(sentence_about("ego: {profile: [{duration: 1 s, yaw_rate: 0.1, steering: 0.1}]}"),
              HasSubstr("ego.profile[0].steering = 0.1: must be absent beside `yaw_rate`"));
  EXPECT_THAT(sentences_about("own_speed: 5\nego: {}\nobjects: [{name: a, x: 9, y: 0, heading: 1}]"), SizeIs(1));
  EXPECT_THAT(sentence_about("ego: {start: {speed: 60}}"), HasSubstr("ego.start.speed = 60"));
  EXPECT_THAT(sentence_about("ego: {vehicle: {model: kinematic, mass: 1000}}"), HasSubstr("ego.vehicle.mass"));
}

TEST(World, AMissingRoadIsOneSentence) {
  for (const std::string text :
       {"objects: [{name: a, at: {lane: -2, s: 10}}]", "ego: {start: {at: {lane: 2, s: 0}}}",
        "ego: {profile: [{duration: 1 s, lane: 3}]}",
        "traffic_lights: [{name: l, at: {lane: 1, s: 5}, phases: [{light: red, duration: 1 s}]}]"})
    EXPECT_THAT(sentences_about(text), SizeIs(1)) << text;
}

TEST(World, ObjectsHaveNamesOfTheirOwn) {
  EXPECT_THAT(sentence_about("objects: [{name: a, x: 9, y: 0}, {name: b, x: 20, y: 0}, {name: a, x: 30, y: 0}]"),
              HasSubstr("objects[2].name = a: must differ from the name of objects[0]"));
}

}  // namespace
}  // namespace ttf::sim::world
