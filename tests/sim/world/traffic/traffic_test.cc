// Objects that drive on a road: published manoeuvres, laws of their motion, queues, lights, classes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "sim/world/traffic/lane_driver.h"
#include "tests/sim/world/drives.h"
#include "tests/support/refusals.h"

namespace ttf::sim::world::traffic {
namespace {

using testing::HasSubstr;

WorldConfig world(const std::string& text, std::int64_t ms = 20'000) {
  WorldConfig config = world_from(text);
  config.duration = Duration::milliseconds(ms);
  return config;
}

std::string sentence_about(const std::string& text) {
  return support::refusal_of([&] { world_from(text); });
}

// esmini's alks_r157_cut_in_quick_brake (v3.6.0, step 0.01 s): a lane change of 3 s from 2 s on, and braking from 4 s on.
// Its actions take effect a step after their trigger. Lanes are 3.07 m wide.
TEST(LaneDriver, CutsInAsPublished) {
  const World is(world("road: {lanes: {left: 0, right: 2, width: 3.07}, start: {y: 3.07}, pieces: [{length: 500}]}\n"
                       "objects: [{name: target, at: {lane: -1, s: 80}, speed: 15, manoeuvres: [{duration: 2010 ms},"
                       "{duration: 2 s, lane: -2, within: 3 s}, {duration: 5 s, acceleration: -5.2}]}]"),
                 1, 0);
  const ObjectState changing = is.state_of(ObjectId{0}, at_ms(2840)), braked = is.state_of(ObjectId{0}, at_ms(6350));
  EXPECT_NEAR(changing.x, 122.585, 2e-3);
  EXPECT_NEAR(changing.y, 0.991, 2e-3);
  EXPECT_NEAR(changing.speed, 15.0, 1e-9);
  EXPECT_NEAR(braked.x, 160.872, 0.02);
  EXPECT_NEAR(braked.speed, 2.832, 1e-3);
  EXPECT_NEAR(braked.y, -1.535, 1e-6);
}

// Positions follow from speed and heading, on a bent road with a lane change, and do not jump between steps of the grid.
TEST(LaneDriver, MovesAsItsStateSays) {
  const WorldConfig config = world(
      "road: {lanes: {left: 1, right: 2}, pieces: [{length: 60}, {length: 60, end_curvature: 0.02}, {length: 300, "
      "curvature: 0.02}]}\n"
      "objects: [{name: a, at: {lane: -1, s: 10}, speed: 12, manoeuvres: [{duration: 3 s, lane: -2},"
      "{duration: 9 s, lane: -1, within: 4 s, speed: 8}, {duration: 3 s, speed: 0, acceleration: 3}]},"
      "{name: b, at: {lane: 1, s: 200}, speed: 10}]");
  const World is(config, 1, 0);
  for (std::uint16_t o = 0; o < 2; ++o)
    for (std::int64_t ms = 10; ms < 19'000; ms += 10) {
      const ObjectState at = is.state_of(ObjectId{o}, at_ms(ms)),
                        before = is.state_of(ObjectId{o}, at_ms(ms) - Duration{1});
      ASSERT_NEAR(std::hypot(at.x - before.x, at.y - before.y), 0.0, 2e-5) << o << ' ' << ms;
      ASSERT_NEAR(std::remainder(at.heading - before.heading, 2.0 * std::numbers::pi), 0.0, 1e-6) << o << ' ' << ms;
      ASSERT_NEAR(at.speed, before.speed, 1e-6) << o << ' ' << ms;
    }
  const road::Road& road = *is.road();
  const ObjectState a = is.state_of(ObjectId{0}, at_ms(18'000)), b = is.state_of(ObjectId{1}, at_ms(5'000));
  EXPECT_EQ(a.speed, 0.0);
  EXPECT_NEAR(road.place_of(a.x, a.y).offset, -1.75, 1e-6);
  EXPECT_NEAR(road.place_of(b.x, b.y).offset, 1.75, 1e-6);
  EXPECT_NEAR(road.place_of(b.x, b.y).station, 200.0 - 50.0 / (1.0 - 0.02 * 1.75), 0.5);
  EXPECT_NEAR(std::remainder(b.heading - road.line_at(road.place_of(b.x, b.y).station).pose.heading - std::numbers::pi,
                             2.0 * std::numbers::pi),
              0.0, 1e-4);
}

TEST(LaneDriver, DrivesStraightOnWhereTheRoadEnds) {
  const World is(world("road: {pieces: [{length: 30}, {length: 30, curvature: 0.02}]}\n"
                       "objects: [{name: a, at: {lane: -1, s: 40}, speed: 20}]"),
                 1, 0);
  const ObjectState a = is.state_of(ObjectId{0}, at_ms(3000)), b = is.state_of(ObjectId{0}, at_ms(8000));
  EXPECT_NEAR(b.x - a.x, 100.0 * std::cos(0.6), 1e-6);
  EXPECT_NEAR(b.heading, 0.6, 1e-9);
}

// One that stops in the middle of a lane change does not slide sideways.
TEST(LaneDriver, DoesNotSlide) {
  const World is(world("road: {lanes: {right: 2}, pieces: [{length: 500}]}\nobjects: [{name: a, at: {lane: -1, s: 0},"
                       "speed: 6, manoeuvres: [{duration: 9 s, speed: 0, acceleration: 4, lane: -2}]}]"),
                 1, 0);
  const ObjectState stopped = is.state_of(ObjectId{0}, at_ms(1510)), later = is.state_of(ObjectId{0}, at_ms(9000));
  EXPECT_NEAR(stopped.y, later.y, 1e-6);
  EXPECT_NEAR(stopped.heading, later.heading, 1e-6);
  EXPECT_LT(later.y, -1.8);
  EXPECT_GT(later.y, -5.0);
}

// In equilibrium the gap is (s0 + v T) / sqrt(1 - (v / v0)^4).
TEST(Following, KeepsTheModelsGap) {
  const Follow follow;
  const double gap = (2.0 + 10.0 * 1.5) / std::sqrt(1.0 - std::pow(10.0 / 13.9, 4));
  EXPECT_NEAR(following(follow, 10.0, gap, 10.0), 0.0, 1e-12);
  EXPECT_NEAR(following(follow, 13.9, 1e12, 0.0), 0.0, 1e-9);
  EXPECT_NEAR(following(follow, 0.0, 1e12, 0.0), 1.0, 1e-9);
  EXPECT_EQ(following(follow, 10.0, 0.5, 0.0), -8.0);
  const World is(world("road: {pieces: [{length: 3000}]}\nobjects: [{name: first, at: {lane: -1, s: 100}, speed: 10},"
                       "{name: second, at: {lane: -1, s: 60}, speed: 10, follow: {}}]",
                       90'000),
                 1, 0);
  const ObjectState first = is.state_of(ObjectId{0}, at_ms(90'000)), second = is.state_of(ObjectId{1}, at_ms(90'000));
  EXPECT_NEAR(first.x - second.x - 4.39, gap, 0.05);
  EXPECT_NEAR(second.speed, 10.0, 0.01);
}

// A queue at a red light, which begins to move when it turns green. The first one stops before the line.
TEST(Following, QueuesAtALight) {
  std::string objects;
  for (int k = 0; k < 4; ++k)
    objects += "{name: q" + std::to_string(k) + ", at: {lane: -1, s: " + std::to_string(60 - 12 * k) +
               "}, speed: 8, follow: {}},";
  const World is(
      world("road: {pieces: [{length: 500}]}\ntraffic_lights: [{name: light, at: {lane: -1, s: 120}, phases: ["
            "{light: red, duration: 30 s}, {light: green, duration: 30 s}]}]\nobjects: [" +
                objects + "]",
            45'000),
      1, 0);
  double ahead = 120.0;
  for (std::uint16_t o = 0; o < 4; ++o) {
    const ObjectState at = is.state_of(ObjectId{o}, at_ms(29'900));
    EXPECT_LT(at.speed, 0.2) << o;
    const double gap = ahead - at.x - (o == 0 ? 0.5 : 1.0) * 4.39;
    EXPECT_NEAR(gap, 2.0, 0.5) << o;
    ahead = at.x;
  }
  EXPECT_GT(is.state_of(ObjectId{0}, at_ms(40'000)).x, 140.0);
  EXPECT_GT(is.state_of(ObjectId{3}, at_ms(45'000)).speed, 3.0);
  EXPECT_EQ(is.lights()[0].x, 120.0);
  EXPECT_EQ(is.lights()[0].y, -1.75);
  EXPECT_EQ(is.lights()[0].heading, std::numbers::pi);
  EXPECT_EQ(shown_at(is.lights()[0], at_ms(29'999)), Light::kRed);
  EXPECT_EQ(shown_at(is.lights()[0], at_ms(30'000)), Light::kGreen);
  EXPECT_EQ(shown_at(is.lights()[0], at_ms(60'000)), Light::kRed);
}

// The sensors' vehicle follows its lane, changes it, and another one follows the vehicle.
TEST(EgoOnRoad, FollowsItsLane) {
  for (const char* model : {"kinematic", "single_track"}) {
    const World is(world("road: {lanes: {left: 0, right: 2}, pieces: [{length: 80}, {length: 60, end_curvature: 0.01}, "
                         "{length: 400, curvature: 0.01}]}\n"
                         "ego: {vehicle: {model: " +
                         std::string(model) +
                         "}, start: {at: {lane: -2, s: 20}, speed: 15},"
                         "profile: [{duration: 9 s}, {duration: 5 s, lane: -1, speed: 12}]}\n"
                         "objects: [{name: behind, at: {lane: -2, s: 0}, speed: 15, follow: {speed: 30}}]"),
                   1, 0);
    const road::Road& road = *is.road();
    double most = 0.0;
    for (std::int64_t ms = 0; ms < 9000; ms += 50) {
      const EgoState ego = is.ego_at(at_ms(ms));
      most = std::max(most, std::abs(road.place_of(ego.x, ego.y).offset + 5.25));
    }
    EXPECT_LT(most, 0.1) << model;
    const EgoState changed = is.ego_at(at_ms(16'000));
    EXPECT_NEAR(road.place_of(changed.x, changed.y).offset, -1.75, 0.05) << model;
    EXPECT_NEAR(changed.vx, 12.0, 0.05) << model;
    // In the vehicle's axes the one behind stays behind.
    EXPECT_LT(is.state_of(ObjectId{0}, at_ms(9000)).x, -15.0) << model;
  }
}

TEST(Classes, GiveSizesAndCrossSections) {
  const World is(
      world("size: {draw: normal}\nobjects: [{name: a, x: 1, y: 0}, {name: b, class: pedestrian, x: 9, y: 0},"
            "{name: c, class: truck, x: 9, y: 0, length: 16, cross_section: 50}]"),
      1, 0);
  EXPECT_NE(is.state_of(ObjectId{0}, at_ms(0)).length, 4.39);
  EXPECT_EQ(is.state_of(ObjectId{0}, at_ms(0)).cross_section, 10.0);
  const ObjectState walker = is.state_of(ObjectId{1}, at_ms(0)), lorry = is.state_of(ObjectId{2}, at_ms(500));
  EXPECT_EQ(walker.kind, ObjectClass::kPedestrian);
  EXPECT_EQ(walker.length, 0.5);
  EXPECT_EQ(walker.cross_section, 0.5);
  EXPECT_EQ(walker.height, 1.75);
  EXPECT_EQ(lorry.length, 16.0);
  EXPECT_EQ(lorry.width, 2.5);
  EXPECT_EQ(lorry.cross_section, 50.0);
}

// A pedestrian walks, stops, turns on the spot, and walks on.
TEST(Classes, PedestriansTurnOnTheSpot) {
  const World is(world("objects: [{name: p, class: pedestrian, x: 10, y: 0, speed: 1.4, segments: [{duration: 2 s},"
                       "{duration: 1 s, speed: 0}, {duration: 1 s, yaw_rate: 1.5708}, {duration: 2 s, speed: 1.4}]}]"),
                 1, 0);
  const ObjectState stood = is.state_of(ObjectId{0}, at_ms(3000)), turned = is.state_of(ObjectId{0}, at_ms(4000)),
                    walked = is.state_of(ObjectId{0}, at_ms(8000));
  EXPECT_EQ(stood.speed, 0.0);
  EXPECT_NEAR(stood.x, 10.0 + 2.8 + 1.4 * 1.4 / 4.0, 1e-6);
  EXPECT_NEAR(turned.x, stood.x, 1e-9);
  EXPECT_NEAR(turned.heading, 1.5708, 1e-9);
  EXPECT_NEAR(walked.speed, 1.4, 1e-9);
  EXPECT_NEAR(walked.x, stood.x, 1e-3);
  EXPECT_GT(walked.y, 5.0);
}

TEST(Traffic, RefusesWhatContradictsItself) {
  const std::string road = "road: {pieces: [{length: 100}]}\n";
  EXPECT_THAT(sentence_about("objects: [{name: a, at: {lane: -1, s: 0}}]"), HasSubstr("objects[0].at"));
  EXPECT_THAT(sentence_about(road + "objects: [{name: a, at: {lane: 1, s: 0}}]"),
              HasSubstr("objects[0].at.lane = 1: must be a lane of the road: -1"));
  EXPECT_THAT(sentence_about(road + "objects: [{name: a, x: 3, y: 0, at: {lane: -1, s: 0}}]"),
              HasSubstr("objects[0].x"));
  EXPECT_THAT(sentence_about("traffic_lights: [{name: a, at: {lane: -1, s: 0}, phases: []}]"),
              HasSubstr("needs a road"));
  EXPECT_THAT(sentence_about("ego: {start: {at: {lane: -1, s: 0}}}"), HasSubstr("needs a road"));
  EXPECT_THAT(sentence_about("ego: {profile: [{duration: 1 s, lane: -1}]}"), HasSubstr("needs a road"));
}

}  // namespace
}  // namespace ttf::sim::world::traffic
