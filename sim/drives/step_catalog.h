// Maps the names of steps in a schedule to code: the known names, the ports of each, and their construction.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "nodes/foreign/libraries.h"
#include "nodes/host/step.h"
#include "nodes/sensing/scene.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/ports.h"
#include "sim/drives/scenario.h"

namespace ttf::sim::drives {

// Returns every step of the program with its ports.
std::span<const schedules::model::StepPorts> step_ports();
// Binds the cluster's tasks to them (schedules/model/ports.h), and checks that they agree about odometry. If one node's fusion
// reads it, each node's does. A service reads it only beside such a fusion. Throws InputError.
void check_steps(const schedules::model::Cluster& cluster);

struct NodeSetConfig {
  const Scenario* scenario = nullptr;
  const schedules::model::Cluster* cluster = nullptr;
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::shared_ptr<const nodes::sensing::Scene> scene;
  std::shared_ptr<const recording::rows::RecordedInput> recorded;  // for clusters with recorded sources
  const nodes::foreign::StepFolder* steps = nullptr;               // for clusters that name libraries
};

// Returns the steps of a node's tasks, in file order. Throws InputError if the schedule's names do not match the
// code's.
std::vector<std::shared_ptr<nodes::host::Step>> make_steps(const NodeSetConfig& config, NodeId node);

// Returns whether the cluster takes its observations from a recording.
bool is_recorded(const schedules::model::Cluster& cluster);

}  // namespace ttf::sim::drives
