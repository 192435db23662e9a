// Sensors with constant errors throughout a drive, and sensors that look elsewhere, in whole clusters.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "fusion/metrics/consistency.h"
#include "nodes/fusion/fusion_host.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/sim/drives/image_copy.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

// The laser's sightings of objects, as the fusion node takes them.
struct LaserSightings final : recording::records::Sink {
  using recording::records::Sink::on;
  std::map<std::uint32_t, std::vector<double>> x, y;  // by list
  void on(const recording::records::ObservationSeen& seen) override {
    if (seen.id.sensor != SensorId{0}) return;
    x[seen.id.sequence].push_back(seen.x);
    y[seen.id.sequence].push_back(seen.y);
  }
  double mean_x() const {
    double sum = 0.0;
    int n = 0;
    for (const auto& list : x)
      for (const double value : list.second) sum += value, ++n;
    return sum / n;
  }
};

// A car that stands 30 m ahead.
Drive standing_car(StrategyKind strategy) {
  Drive drive("scenarios/paper_scenario1.yaml", strategy);
  drive.scenario.tracker = {};
  drive.scenario.world.acceleration_noise = drive.scenario.world.yaw_rate_noise = 0.0;
  sim::world::ObjectConfig& car = drive.scenario.world.objects[0];
  car.x = 30.0;
  car.speed = 0.0;
  car.segments.clear();
  return drive;
}

TEST(BiasedDrive, EveryStrategyHasTheSameDrawAndEveryDriveItsOwn) {
  double plain[3];
  LaserSightings of[3];
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const auto s = static_cast<std::size_t>(strategy);
    Drive drive = standing_car(strategy);
    LaserSightings exact;
    drive.run(exact);
    plain[s] = exact.mean_x();
    drive.scenario.sensors.of<sensors::laser::Kind>().usual.model.range_bias.sigma = 1.0;
    drive.run(of[s]);
    const double drawn = in_drive({0.0, 1.0}, sensors::ErrorOf::kRange, {1, 0, 0}).fixed;
    EXPECT_GT(std::abs(drawn), 0.05);
    EXPECT_NEAR(of[s].mean_x() - plain[s], drawn, 0.03) << name_of(strategy);
    LaserSightings other;
    drive.run(other, 2);
    EXPECT_NEAR(other.mean_x() - plain[s], in_drive({0.0, 1.0}, sensors::ErrorOf::kRange, {2, 0, 0}).fixed, 0.05);
  }
  EXPECT_EQ(of[0].x, of[1].x) << "the same lists, to the bit";
}

TEST(BiasedDrive, AStampsErrorMovesWhatMoves) {
  Drive drive = standing_car(StrategyKind::kTt);
  drive.scenario.world.objects[0].speed = 10.0;
  LaserSightings exact, early;
  drive.run(exact);
  drive.scenario.sensors.of<sensors::laser::Kind>().usual.model.device.time.fixed = 0.05;
  drive.run(early);
  EXPECT_NEAR(early.mean_x() - exact.mean_x(), 0.5, 0.05);
}

// The drive's last prediction for its images, of the car at (30, 0) m. The nearest one counts, since a camera
// sees ghosts.
struct LastPrediction final : recording::records::Sink {
  using recording::records::Sink::on;
  GlobalTime at{};
  double squared = 0.0, distance = std::numeric_limits<double>::infinity();  // NEES of (x, y), error [m]
  void on(const recording::records::TrackState& track) override {
    if (!track.predicted_for_image) return;
    const Eigen::Vector2d error(track.state[0] - 30.0, track.state[1]);
    if (track.valid_at == at && error.norm() >= distance) return;
    at = track.valid_at;
    distance = error.norm();
    Eigen::Matrix2d p;
    p << track.covariance[0], track.covariance[1], track.covariance[6], track.covariance[7];
    squared = fusion::metrics::normalised_squared<2>(error, p);
  }
};

// Draws the car's sizes from the tracker's prior: half a length's error is the centre's. Judges only the position. The car
// stands still, which the tracker does not assume, so it estimates the velocity better than stated. Each drive is judged once,
// at its end.
TEST(BiasedDrive, ConsideredItIsConsistentIgnoredItIsNot) {
  constexpr std::uint64_t kDrives = 150;
  Drive drive = standing_car(StrategyKind::kTt);
  drive.scenario.tracker.process_noise = 0.1;
  const fusion::config::Sizes& prior = drive.scenario.tracker.sizes;
  sim::world::SizeConfig& size = drive.scenario.world.objects[0].size;
  size.draw = sim::world::SizeDraw::kNormal;
  size.mean = {prior.length, prior.width};
  size.sigma = {prior.length_sigma, prior.width_sigma};
  size.correlation = prior.correlation;
  size.normal = {2.0, 7.0, 1.0, 3.0};
  sensors::laser::LaserConfig& laser = drive.scenario.sensors.of<sensors::laser::Kind>().usual.model;
  laser.range_bias.sigma = 0.4;
  laser.azimuth_bias.sigma = drive.scenario.sensors.of<sensors::stereo_camera::Kind>().usual.model.bearing_bias.sigma =
      0.015;
  std::vector<fusion::sensors::KnownSensor>& sensors = drive.scenario.tracker.sensors;
  sensors.resize(2);
  sensors[0].name = "laser";
  sensors[0].errors.sigma << 0.4, 0.015, 0.0, 0.0;
  sensors[1].name = "camera";
  sensors[1].errors.sigma << 0.0, 0.015, 0.0, 0.0;
  double rmse[2] = {};
  for (const auto answer :
       {fusion::config::SystematicErrorsAre::kIgnored, fusion::config::SystematicErrorsAre::kConsidered}) {
    drive.scenario.tracker.systematic = answer;
    fusion::metrics::Consistency nees;
    double& squares = rmse[static_cast<std::size_t>(answer)];
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      LastPrediction last;
      drive.run(last, seed);
      ASSERT_LT(last.distance, 4.0) << "the car is lost, seed " << seed;
      nees.add(last.squared, 2);
      squares += last.distance * last.distance / kDrives;
    }
    if (answer == fusion::config::SystematicErrorsAre::kConsidered)
      EXPECT_TRUE(nees.consistent()) << nees.mean();
    else
      EXPECT_GT(nees.mean(), nees.band().high);
  }
  EXPECT_LT(rmse[1], rmse[0]) << "the camera knows better how far it is";
}

// A scene behind the vehicle, seen by backward sensors, is the scene ahead, rotated.
TEST(MountedDrive, BackwardsIsForwardsTurned) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies) {
    const Drive ahead("scenarios/paper_scenario1.yaml", strategy);
    Drive behind = ahead;
    sim::world::ObjectConfig& car = behind.scenario.world.objects[0];
    car.x = -car.x;
    car.y = -car.y;
    car.heading += std::numbers::pi;
    sensors::kinds::Sensors::each(behind.scenario.sensors,
                                  [](auto& kind) { kind.usual.model.device.placement.heading = std::numbers::pi; });
    for (const char* name : {"laser", "camera"}) {
      fusion::sensors::KnownSensor& sensor = behind.scenario.tracker.sensors.emplace_back();
      sensor.name = name;
      sensor.mounting.yaw = std::numbers::pi;
    }
    Images a, b;
    ahead.run(a);
    behind.run(b);
    ASSERT_EQ(a.written.size(), b.written.size());
    std::size_t objects = 0;
    for (const auto& [sequence, image] : a.written) {
      const std::vector<recording::records::ImageObject>& turned = b.written.at(sequence).objects;
      ASSERT_EQ(image.objects.size(), turned.size()) << sequence;
      for (std::size_t o = 0; o < turned.size(); ++o, ++objects) {
        // Within a step of the code.
        EXPECT_NEAR(turned[o].x, -image.objects[o].x, 0.02) << sequence;
        EXPECT_NEAR(turned[o].y, -image.objects[o].y, 0.02) << sequence;
        EXPECT_NEAR(turned[o].speed, image.objects[o].speed, 0.05) << sequence;
        EXPECT_NEAR(
            std::remainder(turned[o].heading - image.objects[o].heading - std::numbers::pi, 2.0 * std::numbers::pi),
            0.0, 0.01)
            << sequence;
      }
    }
    EXPECT_GT(objects, 40u) << name_of(strategy);
  }
}

// A recording without noise, of a laser on the roof that looks left and a radar at the back that looks
// backwards. The log's sightings and the images are at the car's place.
TEST(MountedDrive, RecordedSensorsSeeFromWhereTheyAre) {
  Drive drive("scenarios/laser_radar_recorded.yaml", StrategyKind::kTt);
  drive.scenario.duration = drive.scenario.world.duration = Duration::milliseconds(5'000);
  std::vector<fusion::sensors::KnownSensor>& sensors = drive.scenario.tracker.sensors;
  sensors.resize(2);
  sensors[0].name = "radar";  // not in the cluster's order
  sensors[0].mounting = {.position = {-2.0, 1.0}, .yaw = std::numbers::pi};
  sensors[0].errors.known << 0.5, 0.0, 0.0;
  sensors[1].name = "laser";
  sensors[1].mounting = {.position = {1.0, 0.5}, .yaw = 0.5 * std::numbers::pi};
  auto recording = std::make_shared<recording::rows::RecordedInput>();
  for (int row = 0; row < 98; ++row) {
    recording::rows::RecordedObservation seen;
    const bool laser = row % 2 == 0;
    seen.time_us_from_start = 50'000 * row;
    const double x = -40.0 + 0.25 * row, y = 3.0;
    if (laser) {
      seen.sensor = "laser";
      seen.x = y - 0.5;
      seen.y = 1.0 - x;
    } else {
      seen.sensor = "radar";
      seen.kind = recording::rows::RecordedObservation::Kind::kRangeBearingRate;
      const double qx = -(x + 2.0), qy = -(y - 1.0);  // in the radar's axes
      seen.range = std::hypot(qx, qy) + 0.5;
      seen.bearing = std::atan2(qy, qx);
      seen.range_rate = -5.0 * qx / std::hypot(qx, qy);
    }
    recording->observations.push_back(seen);
    recording->truth.push_back({seen.time_us_from_start, x, y, 5.0, 0.0, 0.0, 0.0});
  }
  struct Seen final : recording::records::Sink {
    using recording::records::Sink::on;
    std::size_t sightings = 0, predictions = 0;
    void on(const recording::records::ObservationSeen& seen) override {
      const double x = -40.0 + 5.0 * (seen.measured - GlobalTime{}).seconds();
      ++sightings;
      // The instant of row 0 and the clocks' distance are unknown here: some tens of milliseconds.
      EXPECT_NEAR(seen.x, x, 0.5) << index_of(seen.id.sensor);
      EXPECT_NEAR(seen.y, 3.0, 0.01) << index_of(seen.id.sensor);
    }
    void on(const recording::records::TrackState& track) override {
      if (!track.predicted_for_image || track.valid_at < GlobalTime{} + Duration::milliseconds(2'000)) return;
      ++predictions;
      EXPECT_NEAR(track.state[1], 3.0, 0.05);
      EXPECT_NEAR(track.state[2], 5.0, 0.2);
      EXPECT_NEAR(track.state[3], 0.0, 0.1);
    }
  } seen;
  run_drive({&drive.scenario, &drive.cluster, drive.strategy, 1, 0, recording}, seen);
  EXPECT_GT(seen.sightings, 80u);
  EXPECT_GT(seen.predictions, 20u);
}

// The examples of docs/fusion/sensors.md, verbatim.
TEST(BiasedDrive, TheDocumentedKeysLoad) {
  const auto whole = [](const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(shipped(path)).rdbuf();
    return text.str();
  };
  std::string scenario = whole("scenarios/paper_scenario1.yaml");
  scenario.resize(scenario.find("\ntracker:") + 1);
  const std::string page = whole("docs/fusion/sensors.md"), begin = "```yaml\n";
  std::vector<std::string> blocks;
  for (std::size_t from = page.find(begin); from != std::string::npos; from = page.find(begin, from)) {
    from += begin.size();
    blocks.push_back(page.substr(from, page.find("```", from) - from));
  }
  ASSERT_EQ(blocks.size(), 6u);
  const auto mono_camera = [&](const std::string& block, const char* file) {
    return parse_scenario(scenario + block, shipped(file)).sensors.of<sensors::mono_camera::Kind>().usual.model;
  };
  const sensors::mono_camera::MonoCameraConfig mono = mono_camera(blocks[1], "scenarios/mono.yaml");
  EXPECT_EQ(mono.region_count, 1u);
  EXPECT_EQ(mono.pitch.sigma, 0.001);
  EXPECT_EQ(mono_camera(blocks[2], "scenarios/marks.yaml").marks.miss_probability, 0.05);
  const std::string drawn = scenario.substr(0, scenario.find("\nworld:") + 1) + blocks[3];
  const sim::world::WorldConfig world = parse_scenario(drawn, shipped("scenarios/drawn.yaml")).world;
  EXPECT_EQ(world.acceleration_noise, 20.0);
  EXPECT_EQ(world.speed_memory, Duration::milliseconds(500));
  EXPECT_EQ(world.own_speed, 15.0);
  ASSERT_EQ(world.objects.size(), 2u);
  EXPECT_EQ(world.objects[0].size.draw, sim::world::SizeDraw::kNormal);
  EXPECT_EQ(world.objects[1].size.draw, sim::world::SizeDraw::kNominal);
  EXPECT_EQ(world.objects[1].length, 12.0);
  const std::string by_name = blocks[4];
  EXPECT_NE(whole("scenarios/two_lasers.yaml").find(by_name.substr(by_name.find("  right_laser"))), std::string::npos);
  EXPECT_EQ(parse_scenario(scenario + by_name, "by_name.yaml").sensors.of<sensors::laser::Kind>().own.size(), 2u);
  scenario += blocks[0] + blocks[5];
  const Scenario loaded = parse_scenario(scenario, shipped("scenarios/documented.yaml"));
  const auto& laser = loaded.sensors.of<sensors::laser::Kind>().usual.model;
  const auto& camera = loaded.sensors.of<sensors::stereo_camera::Kind>().usual.model;
  EXPECT_EQ(laser.device.placement.x, 3.5);
  EXPECT_EQ(laser.range_bias.sigma, 0.3);
  EXPECT_EQ(laser.device.time.fixed, 0.005);
  EXPECT_EQ(camera.bearing_bias.fixed, -0.005);
  EXPECT_EQ(camera.disparity_bias.sigma, 0.1);
  EXPECT_EQ(loaded.tracker.systematic, fusion::config::SystematicErrorsAre::kConsidered);
  Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kTt);
  const fusion::config::TrackerConfig tracker =
      nodes::fusion::tracker_in(drive.cluster, loaded.tracker, "documented.yaml");
  ASSERT_EQ(tracker.sensors.size(), 2u);
  EXPECT_EQ(tracker.sensors[0].errors.sigma(0), 0.3);
  EXPECT_EQ(tracker.sensors[1].mounting.position.x(), 1.8);
}

TEST(BiasedDrive, ASensorThatIsNoneIsRefused) {
  Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kTt);
  fusion::sensors::KnownSensor& sensor = drive.scenario.tracker.sensors.emplace_back();
  sensor.name = "sonar";
  sensor.line = 17;
  try {
    check_fits(drive.scenario, drive.cluster, drive.strategy, false);
    FAIL() << "taken";
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1u);
    EXPECT_EQ(error.findings()[0].key, "tracker.sensors.sonar");
    EXPECT_EQ(error.findings()[0].line, 17);
    EXPECT_NE(error.findings()[0].sentence().find("laser or camera"), std::string::npos)
        << error.findings()[0].sentence();
  }
}

}  // namespace
}  // namespace ttf::sim::drives
