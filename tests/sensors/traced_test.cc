// A trace as the scene: between its messages, at its ends, and from its host vehicle.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "recording/osi/osi_export.h"
#include "sensors/traced.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sensors {
namespace {

using recording::osi::TracedObject;
using recording::osi::TracedState;
using recording::osi::TruthTrace;

constexpr TrueTime kStart{7'000'000};
constexpr double kTurn = 0.4, kRadius = 25.0, kGap = 0.02;  // [rad/s], [m], [s]

// On a circle about the origin, at constant speed.
TracedState on_circle(double t) {
  const double angle = kTurn * t, v = kTurn * kRadius;
  return {kRadius * std::cos(angle), kRadius * std::sin(angle),    angle + 0.5 * std::numbers::pi, -v * std::sin(angle),
          v * std::cos(angle),       -v * kTurn * std::cos(angle), -v * kTurn * std::sin(angle),   kTurn};
}

TruthTrace circling(int messages) {
  TruthTrace trace;
  TracedObject& object = trace.objects.emplace_back();
  object.length = 4.0;
  object.width = 2.0;
  object.lives.push_back({});
  for (int k = 0; k < messages; ++k) {
    trace.instants.push_back(Duration::milliseconds(20 * k));
    object.lives[0].states.push_back(on_circle(kGap * k));
  }
  return trace;
}

std::vector<sim::world::ObjectState> seen(const TruthTrace& trace, Duration at) {
  const TracedScene scene(std::make_shared<TruthTrace>(trace), kStart);
  std::vector<sim::world::ObjectState> states;
  scene.states_at(kStart + at, states);
  return states;
}

// The cubic's error is at most h^4 / 384 of the fourth derivative, R w^4: below 1e-9 m here.
TEST(TracedScene, GoesOnBetweenMessages) {
  const TruthTrace trace = circling(401);
  for (int ms = 0; ms <= 8000; ms += 7) {
    const auto states = seen(trace, Duration::milliseconds(ms));
    ASSERT_EQ(states.size(), 1u);
    const TracedState is = on_circle(0.001 * ms);
    EXPECT_NEAR(states[0].x, is.x, 1e-9);
    EXPECT_NEAR(states[0].y, is.y, 1e-9);
    EXPECT_NEAR(std::remainder(states[0].heading - is.heading, 2.0 * std::numbers::pi), 0.0, 1e-12);
    EXPECT_NEAR(states[0].speed, kTurn * kRadius, 2e-4);
    EXPECT_NEAR(states[0].acceleration, 0.0, 2e-4);
    EXPECT_EQ(states[0].yaw_rate, kTurn);
  }
  // Outside the trace it stands as at its ends.
  EXPECT_EQ(seen(trace, Duration::milliseconds(-5))[0].x, kRadius);
  EXPECT_EQ(seen(trace, Duration::milliseconds(9000))[0].x, seen(trace, Duration::milliseconds(8000))[0].x);
}

TEST(TracedScene, TheHeadingGoesTheShorterWay) {
  TruthTrace trace = circling(2);
  trace.objects[0].lives[0].states[0].heading = 3.1;
  trace.objects[0].lives[0].states[1].heading = -3.1;
  EXPECT_NEAR(std::abs(seen(trace, Duration::milliseconds(10))[0].heading), std::numbers::pi, 1e-12);
}

TEST(TracedScene, ObjectsComeAndGo) {
  TruthTrace trace = circling(10);
  trace.objects.push_back(trace.objects[0]);
  trace.objects[1].lives = {{2, {on_circle(0), on_circle(0)}}, {6, {on_circle(0)}}};
  const auto there = [&](std::int64_t ms) { return seen(trace, Duration::milliseconds(ms)).size() == 2; };
  EXPECT_FALSE(there(39));
  EXPECT_TRUE(there(40));
  EXPECT_TRUE(there(59));
  EXPECT_TRUE(there(60));
  EXPECT_FALSE(there(61));
  EXPECT_TRUE(there(120));
  EXPECT_FALSE(there(121));
  EXPECT_EQ(seen(trace, Duration::milliseconds(120))[1].id, ObjectId{1});
}

// A host on the circle sees the circle's middle at the same place at all times. Its rear axle is 1.5 m behind the middle of its
// box, and slips outwards.
TEST(TracedScene, IsSeenFromTheHost) {
  TruthTrace trace = circling(401);
  trace.host.emplace();
  trace.host->vehicle = trace.objects[0];
  trace.host->rear_x = -1.5;
  for (TracedState& state : trace.objects[0].lives[0].states) state = {};
  for (int ms = 0; ms <= 8000; ms += 13) {
    const auto states = seen(trace, Duration::milliseconds(ms));
    EXPECT_NEAR(states[0].x, 1.5, 1e-9);
    EXPECT_NEAR(states[0].y, kRadius, 1e-9);
    EXPECT_EQ(states[0].speed, 0.0);
    const TracedScene scene(std::make_shared<TruthTrace>(trace), kStart);
    const sim::world::EgoState ego = scene.ego_at(kStart + Duration::milliseconds(ms));
    EXPECT_NEAR(ego.vx, kTurn * kRadius, 2e-4);
    EXPECT_NEAR(ego.vy, -1.5 * kTurn, 2e-4);
    EXPECT_EQ(ego.yaw_rate, kTurn);
    EXPECT_NEAR(std::hypot(ego.x, ego.y), std::hypot(kRadius, 1.5), 1e-9);
    EXPECT_NEAR(ego.acceleration, 1.5 * kTurn * kTurn, 2e-4);
  }
}

// A vehicle that drives and turns: the trace is over ground, and seen from its host it is the log's again.
TEST(TracedScene, IsThatOfTheTruthThatWasExported) {
  const recording::records::EgoTruth ego{TrueTime{5'000'000}, 100.0, -20.0, 1.2, 9.0, -0.1, 0.3, 0.7, {}, {}, {}};
  recording::records::TruthState car;
  car.at = ego.at;
  car.x = 30.0;
  car.y = 4.0;
  car.heading = -0.5;
  car.speed = 6.0;
  car.acceleration = -1.0;
  car.length = 4.0;
  car.width = 2.0;
  std::string bytes;
  recording::osi::OsiExport files([](TrueTime, std::string_view) {},
                                  [&](TrueTime, std::string_view m) { bytes += recording::osi::framed(m); });
  files.on(ego);
  files.on(car);
  files.finish();
  const TruthTrace trace = recording::osi::parse_truth_trace(bytes, "a.osi");
  const TracedState& is = trace.objects[0].lives[0].states[0];
  EXPECT_NEAR(is.x, 100.0 + 30.0 * std::cos(1.2) - 4.0 * std::sin(1.2), 1e-12);
  EXPECT_NEAR(is.heading, 0.7, 1e-12);
  EXPECT_NEAR(is.vx, 6.0 * std::cos(0.7), 1e-12);
  const TracedScene scene(std::make_shared<TruthTrace>(trace), TrueTime{});
  const sim::world::EgoState again = scene.ego_at(TrueTime{});
  EXPECT_NEAR(again.x, ego.x, 1e-12);
  EXPECT_NEAR(again.y, ego.y, 1e-12);
  EXPECT_NEAR(again.heading, ego.heading, 1e-12);
  EXPECT_NEAR(again.vx, ego.vx, 1e-12);
  EXPECT_NEAR(again.vy, ego.vy, 1e-12);
  EXPECT_NEAR(again.acceleration, ego.acceleration, 1e-12);
  std::vector<sim::world::ObjectState> states;
  scene.states_at(TrueTime{}, states);
  ASSERT_EQ(states.size(), 1u);
  EXPECT_NEAR(states[0].x, car.x, 1e-12);
  EXPECT_NEAR(states[0].y, car.y, 1e-12);
  EXPECT_NEAR(states[0].heading, car.heading, 1e-12);
  EXPECT_NEAR(states[0].speed, car.speed, 1e-12);
  EXPECT_NEAR(states[0].acceleration, car.acceleration, 1e-12);
}

TEST(TracedScene, AllocatesNothing) {
  const TracedScene scene(std::make_shared<TruthTrace>(circling(100)), kStart);
  std::vector<sim::world::ObjectState> states;
  states.reserve(scene.objects());
  const std::int64_t before = support::allocations();
  for (int ms = 0; ms < 1900; ++ms) scene.states_at(kStart + Duration::milliseconds(ms), states);
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace ttf::sensors
