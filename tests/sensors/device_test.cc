// Where sensors are, and the errors of a whole drive.
#include "sensors/device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "sensors/laser/model.h"
#include "sensors/stereo_camera/model.h"

namespace ttf::sensors {
namespace {

TEST(DriveError, IsFixedUnlessItHasASigma) {
  for (const double fixed : {0.0, -0.0, 0.3}) {
    const DriveError error = in_drive({fixed, 0.0}, ErrorOf::kRange, {1, 2, 3});
    EXPECT_EQ(error.fixed, fixed);
    EXPECT_EQ(std::signbit(error.fixed), std::signbit(fixed));
  }
}

// Every drive, sensor and kind of error has its own draw, for any caller and any number of calls.
TEST(DriveError, IsDrawnOncePerDriveSensorAndKind) {
  std::set<double> draws;
  for (const std::uint64_t seed : {1u, 2u})
    for (const std::uint32_t replication : {0u, 1u})
      for (const std::uint16_t sensor : {std::uint16_t{0}, std::uint16_t{1}})
        for (const ErrorOf what : {ErrorOf::kTime, ErrorOf::kRange, ErrorOf::kBearing, ErrorOf::kDisparity}) {
          const DriveKey key{seed, replication, sensor};
          const DriveError once = in_drive({0.0, 1.0}, what, key), again = in_drive({0.0, 1.0}, what, key);
          EXPECT_EQ(once.fixed, again.fixed);
          EXPECT_EQ(once.sigma, 0.0);
          EXPECT_EQ(in_drive({3.0, 2.0}, what, key).fixed, 3.0 + 2.0 * once.fixed);
          draws.insert(once.fixed);
        }
  EXPECT_EQ(draws.size(), 32u);
}

TEST(DriveError, HasItsSigma) {
  constexpr int kDrives = 4000;
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t run = 0; run < kDrives; ++run) {
    const double error = in_drive({0.0, 0.2}, ErrorOf::kRange, {7, run, 0}).fixed;
    sum += error / kDrives;
    squares += error * error / kDrives;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 * 0.2 / std::sqrt(kDrives));
  EXPECT_NEAR(squares, 0.04, 4.0 * 0.04 * std::sqrt(2.0 / kDrives));
}

// A sensor's draws for a drive change neither its noise nor its other errors.
TEST(DriveError, OfASensorAreItsOwn) {
  laser::LaserConfig laser;
  laser.range_bias.sigma = 0.1;
  const laser::LaserConfig range_only = in_drive(laser, {1, 0, 0});
  laser.azimuth_bias.sigma = 0.01;
  laser.device.time.sigma = 0.02;
  const laser::LaserConfig all = in_drive(laser, {1, 0, 0});
  EXPECT_EQ(range_only.range_bias.fixed, all.range_bias.fixed);
  EXPECT_EQ(range_only.azimuth_bias.fixed, 0.0);
  EXPECT_NE(all.azimuth_bias.fixed, 0.0);
  EXPECT_NE(all.device.time.fixed, 0.0);
  stereo_camera::CameraConfig camera;
  camera.bearing_bias.sigma = camera.disparity_bias.sigma = 0.1;
  const stereo_camera::CameraConfig drawn = in_drive(camera, {1, 0, 1});
  EXPECT_NE(drawn.bearing_bias.fixed, 0.0);
  EXPECT_NE(drawn.disparity_bias.fixed, 0.0);
  EXPECT_NE(drawn.bearing_bias.fixed, all.azimuth_bias.fixed) << "another sensor";
}

TEST(Placement, ObjectsAreWhereTheSensorSeesThem) {
  ObjectState car;
  car.x = 10.0;
  car.y = 3.0;
  car.heading = 0.5;
  std::vector<ObjectState> objects{car};
  see_from({}, objects);
  EXPECT_EQ(objects[0].x, 10.0);
  see_from({.x = 2.0, .y = 1.0, .heading = 0.5 * std::numbers::pi}, objects);
  EXPECT_NEAR(objects[0].x, 2.0, 1e-12) << "what is to the left is ahead";
  EXPECT_NEAR(objects[0].y, -8.0, 1e-12);
  EXPECT_NEAR(objects[0].heading, 0.5 - 0.5 * std::numbers::pi, 1e-12);
}

TEST(Placement, AStampErrsByWholeNanoseconds) {
  Device device;
  const TrueTime at{1'000'000'000};
  EXPECT_EQ(measured_at(at, device), at);
  device.time.fixed = -0.02;
  EXPECT_EQ(measured_at(at, device), TrueTime{980'000'000});
}

TEST(Placement, IsReadStrictly) {
  const auto mistakes = [](const std::string& text) {
    Findings findings;
    YamlMap root = StrictYaml::parse(text, "l.yaml").root(findings);
    (void)laser::load_laser(root);
    root.finish();
    std::vector<std::string> sentences;
    for (const Finding& finding : findings.list()) sentences.push_back(finding.sentence());
    return sentences;
  };
  EXPECT_EQ(mistakes("mounting: {x: 1, y: 2, heading: 3}\ntime_bias: -5 ms\ntime_bias_sigma: 5 ms\n"
                     "range_bias_sigma: 0.1\nazimuth_bias_sigma: 0.01\n")
                .size(),
            0u);
  ASSERT_EQ(mistakes("range_bias_sigma: -1\n").size(), 1u);
  EXPECT_EQ(mistakes("range_bias_sigma: -1\n")[0], "l.yaml:1: range_bias_sigma = -1: must be a number 0..5 m");
  EXPECT_EQ(mistakes("mounting: {heading: 8}\n")[0], "l.yaml:1: mounting.heading = 8: must be a number -7..7 rad");
  EXPECT_EQ(mistakes("time_bias: 2 s\n").size(), 1u);
  EXPECT_EQ(mistakes("time_bias_sigma: -1 ms\n").size(), 1u);
}

}  // namespace
}  // namespace ttf::sensors
