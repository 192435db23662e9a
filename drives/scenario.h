// A drive: what the world does, what the sensors are like, which cluster each strategy runs on, and the seed. One YAML
// file under scenarios/; everything it leaves open has a documented default in the room that uses it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "drives/startup.h"
#include "faults/plan.h"
#include "fusion/config/tracker_config.h"
#include "fusion/strategies/strategy.h"
#include "nodes/camera/triangulation.h"
#include "nodes/laser/laser_preprocessor.h"
#include "nodes/sensing/recorded.h"
#include "nodes/service/feature_service.h"
#include "schedules/model/cluster.h"
#include "sim/world/camera.h"
#include "sim/world/laser.h"
#include "sim/world/reference.h"
#include "sim/world/world.h"

namespace ttf::drives {

struct Scenario {
  std::string name;
  std::string description;
  std::string file;
  std::string text;  // the YAML as read, attached to logs
  std::uint64_t seed = 1;
  Duration duration{};       // of the drive, from its start (drives/drive.h)
  Duration evaluate_from{};  // likewise; measures and pictures start here, before it the tracker warms up
  Startup startup;
  // By StrategyKind, as paths that can be opened.
  std::array<std::string, fusion::strategies::kStrategyCount> cluster_files;
  sim::world::WorldConfig world;
  sim::world::LaserConfig laser;
  sim::world::CameraConfig camera;
  sim::world::ReferenceConfig reference;
  nodes::laser::LaserPreprocessingConfig laser_preprocessing;
  nodes::camera::CameraCalibration camera_calibration;
  fusion::config::TrackerConfig tracker;
  nodes::sensing::RecordedNoise recorded_noise;
  nodes::service::FeatureConfig feature;
  faults::FaultPlan faults;  // names as written: resolve() looks them up in the cluster of the drive
};

// Throws InputError with every finding in the file. The clusters it names are not opened here.
Scenario load_scenario(const std::string& path);
// The same of a text; `name` is what errors call it, and clusters are looked for in its folder.
Scenario parse_scenario(std::string text, std::string name);

}  // namespace ttf::drives
