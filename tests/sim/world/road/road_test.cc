// Roads: closed forms of arcs and clothoids, continuity, places beside the line, marks, and refused files.
#include "sim/world/road/road.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/refusals.h"

namespace ttf::sim::world::road {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

RoadConfig road_from(const std::string& text) {
  const StrictYaml yaml = StrictYaml::parse(text, "test.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  RoadConfig config = load_road(root);
  findings.throw_if_any();
  return config;
}

std::string sentence_about(const std::string& text) {
  return support::refusal_of([&] { road_from(text); });
}

// Straight, into a left bend, back, and into a right one.
RoadConfig winding() {
  return road_from(
      "start: {x: 5, y: -3, heading: 0.4}\nlanes: {left: 1, right: 2}\npieces: [{length: 40},"
      "{length: 50, end_curvature: 0.02}, {length: 60, curvature: 0.02},"
      "{length: 80, curvature: 0.02, end_curvature: -0.03}, {length: 30, curvature: -0.03}]");
}

// The Fresnel integrals of pi t^2 / 2 by their power series, which converge for any argument.
Pose fresnel(double t) {
  double c = 0.0, s = 0.0;
  const double u = 0.5 * kPi * t * t;
  double term = t;  // t u^n / n!
  for (int n = 0; n < 60; ++n) {
    const double sign = n / 2 % 2 == 0 ? 1.0 : -1.0;
    (n % 2 == 0 ? c : s) += sign * term / (2 * n + 1);
    term *= u / (n + 1);
  }
  return {c, s, u};
}

TEST(Road, StraightsAndArcsAreClosedForms) {
  const Road road(
      road_from("start: {x: 1, y: 2, heading: 0.3}\npieces: [{length: 100}, {length: 80, curvature: -0.05}]"));
  EXPECT_NEAR(road.line_at(70.0).pose.x, 1.0 + 70.0 * std::cos(0.3), 1e-12);
  EXPECT_NEAR(road.line_at(70.0).pose.y, 2.0 + 70.0 * std::sin(0.3), 1e-12);
  const double x = 1.0 + 100.0 * std::cos(0.3), y = 2.0 + 100.0 * std::sin(0.3);
  const Pose end = road.line_at(180.0).pose;
  EXPECT_NEAR(end.heading, 0.3 - 4.0, 1e-12);
  EXPECT_NEAR(end.x, x + (std::sin(0.3 - 4.0) - std::sin(0.3)) / -0.05, 1e-9);
  EXPECT_NEAR(end.y, y - (std::cos(0.3 - 4.0) - std::cos(0.3)) / -0.05, 1e-9);
}

// A clothoid from a straight is x + iy = a (C(s / a) + i S(s / a)) with a = sqrt(pi / k').
TEST(Road, ClothoidsAreFresnelIntegrals) {
  for (const double end_curvature : {0.01, 0.1, 0.4}) {
    constexpr double kLength = 30.0;
    const Road road(road_from("pieces: [{length: 30, end_curvature: " + std::to_string(end_curvature) + "}]"));
    const double a = std::sqrt(kPi * kLength / end_curvature);
    for (double s = 0.5; s <= kLength; s += 3.7) {
      const Pose exact = fresnel(s / a), is = road.line_at(s).pose;
      EXPECT_NEAR(is.x, a * exact.x, 1e-9) << end_curvature << ' ' << s;
      EXPECT_NEAR(is.y, a * exact.y, 1e-9) << end_curvature << ' ' << s;
      EXPECT_NEAR(is.heading, exact.heading, 1e-12);
    }
  }
}

TEST(Road, JoinsWithoutABend) {
  const Road road(winding());
  constexpr double kNear = 1e-7;
  for (const double joint : {0.0, 40.0, 90.0, 150.0, 230.0, 260.0}) {
    const Pose before = road.line_at(joint - kNear).pose, after = road.line_at(joint + kNear).pose;
    EXPECT_NEAR(after.x - before.x, 2.0 * kNear * std::cos(before.heading), 1e-12) << joint;
    EXPECT_NEAR(after.y - before.y, 2.0 * kNear * std::sin(before.heading), 1e-12) << joint;
    EXPECT_NEAR(after.heading, before.heading, 0.06 * kNear + 1e-12) << joint;
  }
  EXPECT_EQ(road.length(), 260.0);
  EXPECT_NEAR(road.line_at(65.0).curvature, 0.01, 1e-12);
}

TEST(Road, FindsAPlaceAgain) {
  const Road road(winding());
  for (double s = -30.0; s < 300.0; s += 7.3)
    for (const double offset : {-7.0, -0.4, 0.0, 3.1}) {
      const Pose pose = road.pose_at({s, offset});
      const LinePlace found = road.place_of(pose.x, pose.y), near = road.place_near(pose.x, pose.y, s + 2.0);
      EXPECT_NEAR(found.station, s, 1e-8) << s << ' ' << offset;
      EXPECT_NEAR(found.offset, offset, 1e-9) << s << ' ' << offset;
      EXPECT_NEAR(near.station, s, 1e-8) << s << ' ' << offset;
    }
}

TEST(Road, NumbersItsLanes) {
  const Road road(winding());
  EXPECT_EQ(road.middle(1), 1.75);
  EXPECT_EQ(road.middle(-2), -5.25);
  EXPECT_EQ(Road::direction(1), -1.0);
  EXPECT_EQ(Road::direction(-2), 1.0);
  EXPECT_EQ(road.marks(), 4u);
}

TEST(Road, ClosedGoesRound) {
  const Road ring(road_from("pieces: [{length: 125.66370614, curvature: 0.05}]\nclosed: true"));
  EXPECT_NEAR(ring.line_at(130.0).pose.x, ring.line_at(130.0 - 125.66370614).pose.x, 1e-9);
  EXPECT_NEAR(ring.ahead(120.0, 4.0), 9.66370614, 1e-9);
  EXPECT_NEAR(ring.ahead(4.0, 120.0), -9.66370614, 1e-9);
  EXPECT_NEAR(ring.place_of(-25.0, 20.0).station, 125.66370614 * 0.75, 1e-6);
}

// The mark's own curve in the vehicle's axes, point by point: its offset, slope and curvature.
TEST(Road, ShowsMarksAsTheirCurvesAre) {
  const Road road(winding());
  const Pose on = road.pose_at({100.0, -1.5});
  const Pose vehicle{on.x, on.y, on.heading + 0.05};
  for (std::size_t m = 0; m < road.marks(); ++m) {
    constexpr double kStep = 0.05;
    for (double ahead = 0.0; ahead < 25.0; ahead += 5.0) {
      const Mark before = road.mark_at(m, vehicle, ahead - kStep), is = road.mark_at(m, vehicle, ahead),
                 after = road.mark_at(m, vehicle, ahead + kStep);
      const double slope = (after.offset - before.offset) / (2.0 * kStep);
      EXPECT_NEAR(std::tan(is.heading), slope, 1e-5);
      const double bend = (after.offset - 2.0 * is.offset + before.offset) / (kStep * kStep);
      EXPECT_NEAR(is.curvature, bend * std::pow(std::cos(is.heading), 3), 1e-4);
    }
  }
  EXPECT_TRUE(road.mark_at(0, vehicle, 0.0).solid && road.mark_at(3, vehicle, 0.0).solid);
  EXPECT_FALSE(road.mark_at(1, vehicle, 0.0).solid || road.mark_at(2, vehicle, 0.0).solid);
  // From the other direction the same mark is on the other side.
  const Mark along = road.mark_at(0, on, 0.0), against = road.mark_at(0, {on.x, on.y, on.heading + kPi}, 0.0);
  EXPECT_NEAR(along.offset, -5.5, 1e-9);
  EXPECT_NEAR(against.offset, 5.5, 1e-9);
  EXPECT_NEAR(against.heading, 0.0, 1e-9);
  EXPECT_NEAR(against.curvature, -along.curvature, 1e-9);
}

TEST(Road, RefusesWhatIsNone) {
  EXPECT_THAT(sentence_about("pieces: []"), HasSubstr("must have one piece or more"));
  EXPECT_THAT(sentence_about("pieces: [{length: 100, curvature: 0.05}]\nclosed: true"),
              HasSubstr("closed = true: must be false, since the road ends"));
  EXPECT_THAT(sentence_about("pieces: [{length: 10}]\nlanes: {left: 0, right: 0}"), HasSubstr("must be at least 1"));
  EXPECT_THAT(sentence_about("pieces: [{length: 10000, end_curvature: 0.5}]"),
              HasSubstr("length = 10000: must be at most 100 m"));
}

}  // namespace
}  // namespace ttf::sim::world::road
