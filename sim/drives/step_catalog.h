// The program's steps: a row has a step's name with its ports, its role, its maker and its check. A table of rows with a gap
// does not compile.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "nodes/foreign/libraries.h"
#include "nodes/host/step.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/ports.h"
#include "sensors/scene.h"
#include "sim/drives/scenario.h"

namespace ttf::nodes::fusion {
struct FusionHost;
}  // namespace ttf::nodes::fusion

namespace ttf::sim::drives {

struct NodeSetConfig {
  const Scenario* scenario = nullptr;
  const schedules::model::Cluster* cluster = nullptr;
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::shared_ptr<const sensors::Scene> scene;
  std::shared_ptr<const recording::rows::RecordedInput> recorded;  // for clusters with recorded sources
  const nodes::foreign::StepFolder* steps = nullptr;               // for clusters that name libraries
};

// The part of a step in a cluster. Code that distinguishes steps asks for the role, and not for the name.
enum class StepRole : std::uint8_t {
  kEmulator,
  kRecordedSource,
  kPreprocessing,
  kDetector,
  kGateway,
  kFusion,
  kImageOutput,
  kFeatureService,
  kCruise,
  kEmergencyBraking,
  kLaneKeeping,
  kBlindSpotWarning,
  kPlanner,
  kControl,
  kActuator,
};

// A task whose step is to be made.
struct StepSite {
  const NodeSetConfig& set;
  const schedules::model::Node& node;
  const schedules::model::Task& task;
  std::shared_ptr<nodes::fusion::FusionHost>& fusion_host;  // shared by the node's steps; null until one needs it

  const schedules::model::Cluster& cluster() const { return *set.cluster; }
  const Scenario& scenario() const { return *set.scenario; }
};

struct StepRow {
  using Maker = std::shared_ptr<nodes::host::Step> (*)(const StepSite&);
  // Checks a task with this step against the scenario.
  using Check = void (*)(const Scenario&, const schedules::model::Cluster&, const schedules::model::Node&,
                         const schedules::model::Task&, Findings&);

  schedules::model::StepPorts ports;
  StepRole role;
  Maker make;
  Check check = nullptr;  // null: the scenario demands nothing
};

// Returns whether every row has a name of its own and a maker.
consteval bool complete(std::span<const StepRow> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].ports.step.empty() || rows[i].make == nullptr) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (rows[i].ports.step == rows[j].ports.step) return false;
  }
  return true;
}

// Returns the name of the sensor whose raw list the task reads.
std::string_view raw_sensor_name(const schedules::model::Cluster& cluster, const schedules::model::Task& task);

// The tables, a group of steps each. Their order is that of names in messages.
std::span<const StepRow> sensor_steps();   // devices and their preprocessing
std::span<const StepRow> fusion_steps();   // from lists of objects to the image and its first user
std::span<const StepRow> driving_steps();  // services that drive the vehicle

// Returns the row of a step, null if the name is none of the program's.
const StepRow* find_step(std::string_view name);
// Returns every step of the program with its ports.
std::vector<schedules::model::StepPorts> step_ports();

// Returns whether the task, or a task of the node or the cluster, has a step of this role.
bool has_role(const schedules::model::Task& task, StepRole role);
bool has_role(const schedules::model::Node& node, StepRole role);
bool has_role(const schedules::model::Cluster& cluster, StepRole role);

struct PlacedTask {
  const schedules::model::Node* node;
  const schedules::model::Task* task;
  std::string path() const;  // its key in the cluster file
};
// Returns the tasks with a step of this role, in the order of the file. The cluster outlives them.
std::vector<PlacedTask> tasks_with(const schedules::model::Cluster& cluster, StepRole role);

// Binds the cluster's tasks to the steps (schedules/model/ports.h), and checks that they agree about odometry. If one node's
// fusion reads it, each node's does. A service reads it only beside such a fusion. Throws InputError.
void check_steps(const schedules::model::Cluster& cluster);
// Checks the scenario's demands on each task by its row. Throws InputError with every finding.
void check_tasks(const Scenario& scenario, const schedules::model::Cluster& cluster);

// Returns the steps of a node's tasks, in file order. Throws InputError if the schedule's names do not match the
// code's.
std::vector<std::shared_ptr<nodes::host::Step>> make_steps(const NodeSetConfig& config, NodeId node);

}  // namespace ttf::sim::drives
