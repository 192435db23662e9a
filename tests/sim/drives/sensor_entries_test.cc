// The sensors of a scenario: which entry holds for which sensor of a cluster, and the sentences about wrong ones.
#include "sensors/kinds/loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "fusion/loading/tracker.h"
#include "nodes/fusion/fusion_host.h"
#include "schedules/file/loader.h"
#include "sim/drives/drive.h"
#include "sim/drives/scenario.h"
#include "sim/drives/step_catalog.h"
#include "sim/drives/surroundings.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

const std::string kFolder = TTF_SOURCE_DIR "/schedules/";

Scenario with(const std::string& text) {
  return parse_scenario(read_file(TTF_SOURCE_DIR "/scenarios/paper_scenario1.yaml") + text, "car.yaml");
}

std::string refusal(const std::string& text, const std::string& cluster = "two_lasers_synchronised") {
  return support::refusal_of(
      [&] {
        const Scenario scenario = with(text);
        schedules::model::Cluster checked = schedules::file::load_cluster(kFolder + cluster + ".yaml");
        checked.file = cluster + ".yaml";
        sensors::kinds::check_sensors(scenario.sensors, scenario.text, scenario.file, checked);
      },
      "taken");
}

TEST(SensorEntries, ASensorHasItsOwnOrThatOfItsKind) {
  const sensors::kinds::Sensors sensors = with(
                                              "sensors:\n"
                                              "  laser: {range_sigma: 0.2, preprocessing: {fewest_points: 7}}\n"
                                              "  left_laser: {kind: laser, mounting: {x: 3.6, y: 0.9}, max_range: 60}\n"
                                              "  right_laser: {kind: laser, preprocessing: {fewest_points: 5}}\n"
                                              "  rear: {kind: camera, focal: 900, time_bias: 1 ms}\n"
                                              "preprocessing: {laser: {fewest_points: 4}, camera: {focal: 1000}}\n")
                                              .sensors;
  const auto& lasers = sensors.of<ttf::sensors::laser::Kind>();
  const auto& cameras = sensors.of<ttf::sensors::stereo_camera::Kind>();
  EXPECT_EQ(lasers.of("left_laser").model.device.placement.y, 0.9);
  EXPECT_EQ(lasers.of("left_laser").model.max_range_m, 60.0);
  EXPECT_EQ(lasers.of("left_laser").model.range_sigma_m, 0.06) << "an entry is complete";
  EXPECT_EQ(lasers.of("laser").model.range_sigma_m, 0.2);
  EXPECT_EQ(lasers.of("any_other").model.range_sigma_m, 0.2);
  EXPECT_EQ(lasers.of("rear").model.range_sigma_m, 0.2) << "that is a camera's";
  EXPECT_EQ(cameras.of("rear").model.focal_px, 900.0);
  EXPECT_EQ(cameras.of("rear").model.device.time.fixed, 0.001);
  EXPECT_EQ(cameras.of("camera").model.focal_px, 1100.0);
  EXPECT_EQ(lasers.preprocessing_of("right_laser").fewest_points, 5);
  EXPECT_EQ(lasers.preprocessing_of("left_laser").fewest_points, 4);
  EXPECT_EQ(lasers.preprocessing_of("any_other").fewest_points, 7);
  EXPECT_EQ(cameras.preprocessing_of("rear").focal_px, 1000.0);
}

TEST(SensorEntries, ThoseOfTheClusterAreTaken) {
  EXPECT_EQ(refusal(""), "taken");
  EXPECT_EQ(refusal("sensors: {laser: {kind: laser}, camera: {kind: camera, period: 40 ms}}\n"), "taken");
  EXPECT_EQ(refusal("sensors: {left_laser: {kind: laser, period: 80 ms}, right_laser: {kind: laser}}\n"), "taken");
  EXPECT_EQ(refusal("sensors: {laser: {}, camera: {}}\n", "twin_cameras"), "taken") << "it has no laser";
  EXPECT_EQ(refusal("sensors: {radar: {}, mono_camera: {}, odometry: {}}\n"), "taken")
      << "an entry may be for no sensor";
  EXPECT_EQ(refusal("sensors: {laser: {period: 1 s}}\n", "laser_radar"), "taken") << "a recording has its own instants";
}

TEST(SensorEntries, OneThatTheScheduleHasNoRoomForIsRefused) {
  EXPECT_THAT(refusal("sensors:\n  laser2: {kind: laser}\n", "paper_synchronised"),
              HasSubstr("car.yaml:36: sensors.laser2: must be a sensor of paper_synchronised.yaml: laser or camera; "
                        "did you mean laser?"));
  EXPECT_THAT(refusal("sensors:\n  right:\n    range_sigma: 0.1\n    kind: laser\n", "twin_cameras"),
              HasSubstr("car.yaml:38: sensors.right.kind = laser: must be camera, as in twin_cameras.yaml"));
  EXPECT_THAT(refusal("sensors: {left_laser: {kind: laser, period: 40 ms}}\n"),
              HasSubstr("sensors.left_laser.period = 40 ms: must be 80 ms, the period of left_laser in "
                        "two_lasers_synchronised.yaml"));
  EXPECT_THAT(refusal("sensors: {laser: {period: 100 ms}}\n"),
              HasSubstr("sensors.laser.period = 100 ms: must be 80 ms, the period of right_laser in"));
  EXPECT_THAT(
      refusal("sensors: {camera: {period: 33.3 ms}}\n", "paper_free_running"),
      HasSubstr("sensors.camera.period = 33.3 ms: must be absent: in paper_free_running.yaml camera measures at "
                "each end of preprocess"));
  EXPECT_THAT(refusal("sensors: {radar: {kind: laser}}\n", "laser_radar"),
              HasSubstr("sensors.radar.kind = laser: must be radar"));
}

TEST(SensorEntries, WrongKeysAreNamed) {
  EXPECT_THAT(refusal("sensors: {laser2: {range_sigma: 0.1}}\n"),
              HasSubstr("sensors.laser2.kind: is missing: must be one of laser, camera, radar, mono_camera, odometry"));
  EXPECT_THAT(refusal("sensors: {lasr: {range_sigma: 0.1}}\n"),
              HasSubstr("sensors.lasr.kind: is missing: must be one of laser, camera, radar, mono_camera, odometry; "
                        "did you mean laser?"));
  EXPECT_THAT(refusal("sensors: {rear: {range_sigma: 0.1}}\n"),
              EndsWith("sensors.rear.kind: is missing: must be one of laser, camera, radar, mono_camera, odometry"));
  EXPECT_THAT(refusal("sensors: {left_lasr: {kind: laser}}\n"), HasSubstr("or camera; did you mean left_laser?"));
  EXPECT_THAT(refusal("sensors: {laser2: 7}\n"), HasSubstr("sensors.laser2: must be a mapping"));
  EXPECT_THAT(refusal("sensors: {laser: {kind: camera}}\n"), HasSubstr("sensors.laser.kind = camera: must be laser"));
  EXPECT_THAT(refusal("sensors: {rear: {kind: sonar}}\n"),
              HasSubstr("sensors.rear.kind = sonar: must be one of laser, camera, radar, mono_camera, odometry"));
  EXPECT_THAT(refusal("sensors: {rear: {kind: laser, focal: 900}}\n"),
              HasSubstr("sensors.rear.focal: is not a known key here"));
  EXPECT_THAT(refusal("sensors: {rear: {kind: camera, preprocessing: {range_noise: 1}}}\n"),
              HasSubstr("sensors.rear.preprocessing.range_noise: is not a known key here"));
  EXPECT_THAT(refusal("sensors: {rear: {kind: laser}, rear: {kind: laser}}\n"),
              HasSubstr("sensors.rear: is given twice in one mapping"));
  EXPECT_THAT(refusal("sensors: {rear: {kind: laser, colour: pink}}\n"),
              HasSubstr("sensors.rear.colour = pink: must be one of vermilion, blue,"));
  EXPECT_THAT(refusal("sensors: {rear: {kind: laser, marker: circle}}\n"),
              HasSubstr("sensors.rear.marker = circle: must be one of cross, plus,"));
}

TEST(SensorEntries, SayHowPicturesShowThem) {
  const schedules::model::Cluster cluster = schedules::file::load_cluster(kFolder + "two_lasers_synchronised.yaml");
  using Style = recording::log::SensorStyle;
  const auto styles = [&](const std::string& text) {
    return sensors::kinds::sensor_styles(with(text).sensors, cluster);
  };
  EXPECT_TRUE(styles("sensors: {laser: {}}\n").empty()) << "as without a word about them";
  EXPECT_THAT(styles("sensors: {right_laser: {kind: laser, marker: diamond}, camera: {}}\n"),
              ElementsAre(Style{}, Style{"laser", "", "diamond"}));
  EXPECT_THAT(styles("sensors: {camera: {colour: green}}\n"), ElementsAre(Style{}, Style{}, Style{"", "green", ""}));
}

// Takes the odometry from the tasks with this step.
schedules::model::Cluster without_odometry(std::string_view step, const std::string& file = "moving") {
  schedules::model::Cluster cluster = schedules::file::load_cluster(kFolder + file + "_synchronised.yaml");
  cluster.file = file + ".yaml";
  cluster.origins = {};
  for (schedules::model::Node& node : cluster.nodes)
    for (schedules::model::Task& task : node.tasks)
      if (task.step == step) std::erase_if(task.reads, [](const auto& read) { return read.port == "odometry"; });
  return cluster;
}

TEST(Odometry, AServiceReadsItBesideAFusionThatDoes) {
  EXPECT_NO_THROW(check_steps(without_odometry("")));
  EXPECT_NO_THROW(check_steps(without_odometry("feature_service")));
  try {
    check_steps(without_odometry("fusion"));
    FAIL() << "is taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex("moving.yaml:[0-9]+: nodes.feature.tasks.use.reads.odometry = "
                                                    "odometry_list: must be read by the fusion, too: .*"));
  }
  try {
    check_steps(without_odometry("fusion", "closed_loop"));
    FAIL() << "is taken";
  } catch (const InputError& error) {
    const std::string what = error.what();
    for (const char* const task : {"use", "cruise", "brake"})
      EXPECT_THAT(what, HasSubstr(std::string("tasks.") + task + ".reads.odometry"));
  }
}

TEST(Odometry, AFusionThatReadsNoneHasATrackerWithoutIt) {
  EXPECT_TRUE(nodes::fusion::tracker_in(without_odometry(""), {}, "car.yaml").odometry);
  EXPECT_FALSE(nodes::fusion::tracker_in(without_odometry("fusion"), {}, "car.yaml").odometry);
  const auto refused = [](const std::string& tracker, std::string_view step) -> std::string {
    return support::refusal_of(
        [&] {
          Findings none;
          YamlMap root = StrictYaml::parse(tracker, "car.yaml").root(none);
          (void)nodes::fusion::tracker_in(without_odometry(step), fusion::loading::load_tracker(root), "car.yaml");
        },
        "taken");
  };
  EXPECT_EQ(refused("motion: ctra\nodometry: {lever: 20}\n", "fusion"),
            "car.yaml:2: tracker.odometry: must be absent: no fusion task of moving.yaml reads odometry");
  EXPECT_EQ(
      refused("cross_noise: 0.5\n", ""),
      "car.yaml:1: tracker.cross_noise = 0.5: must be absent with the odometry of moving.yaml: the vehicle's axes "
      "turn");
}

TEST(Odometry, AVehicleThatMovesWithoutItIsReported) {
  const schedules::model::Cluster measured = without_odometry(""), unread = without_odometry("fusion");
  Scenario scenario = with("");
  EXPECT_EQ(motion_warning(scenario, unread), "");
  scenario.world.ego.emplace();
  EXPECT_EQ(motion_warning(scenario, unread), "") << "it stands";
  scenario.world.ego->actuator.emplace();
  EXPECT_THAT(motion_warning(scenario, unread), HasSubstr("world.ego: moves")) << "commands drive it";
  scenario.world.ego->actuator.reset();
  scenario.world.ego->speed = 5.0;
  EXPECT_EQ(motion_warning(scenario, measured), "");
  EXPECT_THAT(motion_warning(scenario, unread), HasSubstr("world.ego: moves, and moving.yaml has no odometry that its "
                                                          "fusion reads"));
}

}  // namespace
}  // namespace ttf::sim::drives
