// Every shipped drive loads; errors are reported in sentences.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/errors.h"
#include "sim/drives/scenario.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives {
namespace {

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(TTF_SOURCE_DIR "/scenarios"))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(ScenarioFiles, EveryShippedOneLoadsAndItsClustersAreThere) {
  const auto files = shipped();
  EXPECT_GE(files.size(), 4U);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    Scenario scenario;
    ASSERT_NO_THROW(scenario = load_scenario(file.string()));
    EXPECT_EQ(scenario.name, file.stem().string());
    EXPECT_FALSE(scenario.description.empty());
    EXPECT_LT(scenario.evaluate_from, scenario.duration);
    EXPECT_EQ(scenario.world.duration, scenario.duration);
    for (const std::string& cluster : scenario.cluster_files) EXPECT_TRUE(std::filesystem::exists(cluster)) << cluster;
    EXPECT_EQ(scenario.cluster_files[0], scenario.cluster_files[1]) << "BUFF and ADVA share their configuration";
    // Drives that compare the strategies have a separate schedule for TT. Those that start up, compare
    // phases of a schedule, or drive by modes have one cluster.
    const bool one_cluster =
        scenario.startup.cold || scenario.name == "twin_cameras" || scenario.name == "adaptive_detection_modes";
    EXPECT_EQ(scenario.cluster_files[0] == scenario.cluster_files[2], one_cluster);
  }
}

TEST(ScenarioFiles, SensorAndCalibrationDefaultsAgree) {
  // Preprocessing assumes the sensors' real parameters, unless a drive says otherwise.
  const Scenario s;
  const auto& lasers = s.sensors.of<sensors::laser::Kind>();
  const auto& cameras = s.sensors.of<sensors::stereo_camera::Kind>();
  const sensors::laser::LaserConfig& laser = lasers.usual.model;
  const sensors::stereo_camera::CameraConfig& camera = cameras.usual.model;
  EXPECT_EQ(cameras.preprocessing.baseline_m, camera.baseline_m);
  EXPECT_EQ(cameras.preprocessing.focal_px, camera.focal_px);
  EXPECT_EQ(cameras.preprocessing.disparity_sigma_px, camera.disparity_sigma_px);
  EXPECT_EQ(cameras.preprocessing.bearing_sigma_rad, camera.bearing_sigma_rad);
  EXPECT_EQ(cameras.preprocessing.width_sigma_px, camera.width_sigma_px);
  EXPECT_EQ(lasers.preprocessing.segmentation.azimuth_step_rad, laser.azimuth_step_rad);
  EXPECT_EQ(lasers.preprocessing.rectangle.azimuth_step_rad, laser.azimuth_step_rad);
  EXPECT_EQ(lasers.preprocessing.rectangle.range_noise_m, laser.range_sigma_m);
}

TEST(ScenarioFiles, TheWorldHasAsManyObjectsAsSaid) {
  const Scenario crowd = load_scenario(TTF_SOURCE_DIR "/scenarios/crowd.yaml");
  ASSERT_EQ(crowd.world.objects.size(), 25U);
  const std::string key = "object_count: 25";
  const auto with = [&](const std::string& count) {
    std::string text = crowd.text;
    text.replace(text.find(key), key.size(), "object_count: " + count);
    return parse_scenario(text, crowd.file);
  };
  const Scenario two = with("2");
  ASSERT_EQ(two.world.objects.size(), 2U);
  EXPECT_EQ(two.world.objects[1].name, crowd.world.objects[1].name);
  EXPECT_EQ(with("33").world.objects.size(), 33U);
  EXPECT_THROW(with("34"), InputError);
  EXPECT_THROW(with("0"), InputError);
}

TEST(ScenarioFiles, AnUnknownKeyAndATruncatedFileAreRefused) {
  std::ifstream in(TTF_SOURCE_DIR "/scenarios/paper_scenario1.yaml");
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string path = ::testing::TempDir() + "broken_scenario.yaml";
  const auto refused = [&](const std::string& content) -> std::vector<Finding> {
    std::ofstream(path) << content;
    return support::findings_of([&] { load_scenario(path); });
  };
  const auto unknown = refused(text + "\nweather: rain\n");
  ASSERT_EQ(unknown.size(), 1U);
  EXPECT_EQ(unknown[0].key, "weather");
  EXPECT_FALSE(refused(text.substr(0, text.find("clusters:"))).empty());
  EXPECT_FALSE(refused(text.substr(0, text.find("segments:") + 5)).empty());
  EXPECT_FALSE(refused("").empty());
  std::filesystem::remove(path);
  EXPECT_THROW(load_scenario(path), InputError);
}

}  // namespace
}  // namespace ttf::sim::drives
