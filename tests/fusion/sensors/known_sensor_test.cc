// A sensor's known errors: read strictly, and removed from its observations.
#include "fusion/sensors/known_sensor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "fusion/loading/known_sensor.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::sensors {
namespace {

KnownSensor load(const std::string& text, std::vector<std::string>* sentences = nullptr) {
  Findings findings;
  YamlMap root = StrictYaml::parse(text, "s.yaml").root(findings);
  const KnownSensor sensor = loading::load_known_sensor(root);
  root.finish();
  for (const Finding& finding : findings.list())
    if (sentences) sentences->push_back(finding.sentence());
  EXPECT_TRUE(sentences || findings.empty());
  return sensor;
}
std::vector<std::string> mistakes(const std::string& text) {
  std::vector<std::string> sentences;
  load(text, &sentences);
  return sentences;
}

TEST(KnownSensor, NothingIsKnownUnlessSaid) {
  const KnownSensor sensor = load("{}");
  EXPECT_TRUE(sensor.plain());
  EXPECT_TRUE(sensor.errors.sigma.isZero());
}

TEST(KnownSensor, ReadsEveryKey) {
  const KnownSensor sensor = load(
      "mounting: {x: 3.5, y: -0.5, heading: 1.5}\nbias: {range: 0.2, bearing: -0.01, range_rate: 0.3}\n"
      "bias_sigma: {range: 0.1, bearing: 0.02, range_rate: 0.4, time: 5 ms}\n");
  EXPECT_EQ(sensor.mounting.position, Eigen::Vector2d(3.5, -0.5));
  EXPECT_EQ(sensor.mounting.yaw, 1.5);
  EXPECT_EQ(sensor.errors.axes, ErrorAxes::kPolar);
  EXPECT_EQ(sensor.errors.known, Eigen::Vector3d(0.2, -0.01, 0.3));
  EXPECT_EQ(sensor.errors.sigma, Eigen::Vector4d(0.1, 0.02, 0.4, 0.005));
  EXPECT_FALSE(sensor.plain());
  const KnownSensor other = load("bias_sigma: {x: 0.1, y: 0.2}\n");
  EXPECT_EQ(other.errors.axes, ErrorAxes::kCartesian);
  EXPECT_EQ(other.errors.sigma, Eigen::Vector4d(0.1, 0.2, 0.0, 0.0));
  EXPECT_TRUE(other.plain()) << "what is not known cannot be corrected for";
}

TEST(KnownSensor, AFieldIsUnboundedWhereNothingIsSaid) {
  EXPECT_FALSE(load("{}").field.has_value());
  const KnownSensor sensor = load("field: {half_angle: 0.45, min_range: 1, max_range: 90, shadow: 0.5}\n");
  ASSERT_TRUE(sensor.field.has_value());
  EXPECT_EQ(sensor.field->half_angle, 0.45);
  EXPECT_EQ(sensor.field->min_range, 1.0);
  EXPECT_EQ(sensor.field->max_range, 90.0);
  EXPECT_EQ(sensor.field->shadow, 0.5);
  EXPECT_TRUE(sensor.plain()) << "its measurements stay as they are";
  const Field all = load("field: {}\n").field.value();
  EXPECT_TRUE(all.all_around());
  EXPECT_EQ(all.min_range, 0.0);
  EXPECT_EQ(all.max_range, Field::kUnbounded);
  EXPECT_EQ(all.shadow, Field::kUnbounded);
}

TEST(KnownSensor, EveryMistakeIsASentence) {
  using testing::ElementsAre;
  EXPECT_THAT(mistakes("mounting: {x: 60, yaw: 1}\n"),
              ElementsAre("s.yaml:1: mounting.x = 60: must be a number -50..50 m",
                          testing::StartsWith("s.yaml:1: mounting.yaw: is not a known key")));
  EXPECT_THAT(mistakes("bias_sigma: {bearing: -0.1}\n"),
              ElementsAre("s.yaml:1: bias_sigma.bearing = -0.1: must be a number 0..0.5 rad"));
  EXPECT_THAT(mistakes("bias: {x: 1}\nbias_sigma:\n  range: 1\n"),
              ElementsAre("s.yaml:3: bias_sigma.range = 1: must not be mixed with errors in other axes: either x and "
                          "y, or range, bearing and range_rate"));
  EXPECT_THAT(mistakes("field: {half_angle: 4, min_range: 20, max_range: 10}\n"),
              ElementsAre("s.yaml:1: field.half_angle = 4: must be a number 0.01..3.15 rad",
                          "s.yaml:1: field.max_range = 10: must be above min_range"));
  EXPECT_THAT(mistakes("bias_sigma: {time: 2 s}\n"), testing::SizeIs(1));
  EXPECT_THAT(mistakes("bias: {time: 2 ms}\n"), testing::SizeIs(1));
}

// A sensor with known errors sees the truth once they are removed.
TEST(KnownSensor, PlacedIsWhatIsThere) {
  KnownSensor sensor;
  sensor.mounting = {.position = {2.0, -1.0}, .yaw = 2.0};
  const Eigen::Vector2d there(-20.0, 15.0), from_here = there - sensor.mounting.position;
  const double range = from_here.norm(), bearing = std::atan2(from_here.y(), from_here.x()) - sensor.mounting.yaw;
  sensor.errors.known << 0.5, 0.1, 0.25;
  Observation z = position((range + 0.5) * std::cos(bearing + 0.1), (range + 0.5) * std::sin(bearing + 0.1), 0.3);
  z.r(0, 0) = 0.04;
  z.has_heading = true;
  z.heading = 0.3 - sensor.mounting.yaw + 0.1;
  Observation r = radar(range + 0.5, bearing + 0.1, 1.25, 0.1, 0.1, 0.1);
  place(z, SensorId{3}, sensor);
  place(r, SensorId{3}, sensor);
  EXPECT_EQ(z.sensor, SensorId{3});
  EXPECT_LT((z.z.head<2>() - there).norm(), 1e-12);
  EXPECT_NEAR(z.heading, 0.3, 1e-12);
  // The error ellipse has turned with it.
  const double turned = sensor.mounting.yaw - 0.1, c = std::cos(turned), s = std::sin(turned);
  EXPECT_NEAR(z.r(0, 0), 0.04 * c * c + 0.09 * s * s, 1e-12);
  EXPECT_EQ(z.r(0, 1), z.r(1, 0));
  EXPECT_NEAR(r.z(0), range, 1e-12);
  EXPECT_NEAR(r.z(1), bearing, 1e-12);
  EXPECT_NEAR(r.z(2), 1.0, 1e-12);

  sensor.errors.axes = ErrorAxes::kCartesian;
  sensor.errors.known << 0.5, -0.3, 0.0;
  const Eigen::Vector2d moved(range * std::cos(bearing) + 0.5, range * std::sin(bearing) - 0.3);
  z = position(moved.x(), moved.y(), 0.3);
  r = radar(moved.norm(), std::atan2(moved.y(), moved.x()), 1.0, 0.1, 0.1, 0.1);
  place(z, SensorId{3}, sensor);
  place(r, SensorId{3}, sensor);
  EXPECT_LT((z.z.head<2>() - there).norm(), 1e-12);
  EXPECT_NEAR(r.z(0), range, 1e-12);
  EXPECT_NEAR(std::remainder(r.z(1) - bearing, 2.0 * std::numbers::pi), 0.0, 1e-12);
}

TEST(KnownSensor, OfNothingKnownNothingChanges) {
  Observation z = position(-0.0, 3.0, 0.3);
  const Observation before = z;
  place(z, SensorId{1}, KnownSensor{});
  EXPECT_EQ(z.z, before.z);
  EXPECT_TRUE(std::signbit(z.z(0)));
  EXPECT_EQ(z.r, before.r);
}

// Only an axis and the direction into a face are directions; a silhouette's heading means nothing.
TEST(KnownSensor, ADirectionTurnsWithTheMountingAndTheVehicle) {
  for (const double mounted : {0.0, 0.5, -2.2})
    for (const double turned : {0.0, 0.9, 1.57})
      for (const SeenPoint seen : {SeenPoint::kRightmost, SeenPoint::kLeftmost, SeenPoint::kSilhouette}) {
        KnownSensor sensor;
        sensor.mounting = {.position = {3.7, 0.5}, .yaw = mounted};
        Observation z = position(20.0, 1.0, 0.1);
        z.seen = seen;
        z.heading = 0.1;
        place(z, SensorId{1}, sensor);
        carry(z, {.position = {10.0, -4.0}, .yaw = turned});
        const double expected = seen == SeenPoint::kSilhouette ? 0.1 : 0.1 + mounted + turned;
        EXPECT_NEAR(z.heading, expected, 1e-12) << mounted << " " << turned;
      }
}

}  // namespace
}  // namespace ttf::fusion::sensors
