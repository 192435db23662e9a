// A scenario describes a drive: the world, the sensors, the cluster of each strategy, and the seed. It is one
// YAML file under scenarios/. Each omitted key has a documented default in its room.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "faults/plan.h"
#include "fusion/config/tracker_config.h"
#include "fusion/metrics/cut_off.h"
#include "fusion/strategies/strategy.h"
#include "nodes/driving/adaptive_cruise_control.h"
#include "nodes/driving/blind_spot_warning.h"
#include "nodes/driving/emergency_braking.h"
#include "nodes/driving/motion_planner.h"
#include "nodes/driving/steering/lane_keeping.h"
#include "nodes/driving/vehicle_control.h"
#include "nodes/service/feature_service.h"
#include "nodes/vision/config.h"
#include "recording/osi/truth_trace.h"
#include "schedules/model/cluster.h"
#include "sensors/kinds/sensors.h"
#include "sensors/recorded/played_rows.h"
#include "sensors/recorded/recorded.h"
#include "sim/drives/startup.h"
#include "sim/world/reference.h"
#include "sim/world/weather.h"
#include "sim/world/world.h"

namespace ttf::sim::drives {

// A section of a step's parameters that the file has.
struct StepSection {
  std::string step;
  int line = 0;
};

struct Scenario {
  // Defaulted in the source, as its members' are long.
  Scenario();
  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(const Scenario&);
  Scenario& operator=(Scenario&&) noexcept;
  ~Scenario();

  std::string name;
  std::string description;
  std::string file;
  std::string text;  // the YAML as read, attached to logs
  std::uint64_t seed = 1;
  Duration duration{};       // the drive's, from its start (sim/drives/drive.h)
  Duration evaluate_from{};  // from the same start; the tracker warms up before measures and pictures begin
  Startup startup;
  // By StrategyKind, as paths that can be opened.
  std::array<std::string, fusion::strategies::kStrategyCount> cluster_files;
  std::array<int, fusion::strategies::kStrategyCount> cluster_lines{};
  sim::world::WorldConfig world;
  sim::world::Weather weather;
  sensors::kinds::Sensors sensors;  // in that weather
  sim::world::ReferenceConfig reference;
  fusion::config::TrackerConfig tracker;
  sensors::recorded::RecordedNoises recorded_noises;
  sensors::recorded::RecordedPlaying recorded_playing;
  nodes::service::FeatureConfig feature;
  nodes::vision::AdaptiveCameraConfig adaptive_camera;
  nodes::driving::CruiseConfig cruise;
  nodes::driving::EmergencyConfig emergency;
  nodes::driving::steering::LaneKeepingConfig lane_keeping;
  nodes::driving::BlindSpotConfig blind_spot;
  nodes::driving::PlannerConfig planner;
  nodes::driving::ControlConfig control;
  std::vector<StepSection> step_sections;
  double reaction_speed_mps = 27.0;  // the reaction time is judged at it (evaluation/driving/driving_account.h)
  fusion::metrics::CutOff cut_off;   // with which the drive's tracking is judged
  // The world of another simulator, in place of all in `world` that moves (sim/drives/traced.h); null: none.
  std::shared_ptr<const recording::osi::TruthTrace> truth;
  ttf::faults::FaultPlan faults;  // names as written: resolve() looks them up in the drive's cluster
};

// Throws InputError with every finding in the file. The clusters are not opened here.
Scenario load_scenario(const std::string& path);
// Reads a scenario from a text. `name` stands for the file in errors, and its folder is that of the clusters.
Scenario parse_scenario(std::string text, std::string name);
Scenario read_scenario(const StrictYaml& yaml);

// Returns the entry that names the strategy's cluster, for a finding about it.
Finding cluster_entry(const Scenario& scenario, fusion::strategies::StrategyKind strategy);

}  // namespace ttf::sim::drives
