// Which code a cluster's steps are: the names a schedule may use, the ports each has, and how one is made.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drives/scenario.h"
#include "nodes/sensing/scene.h"
#include "nodes/host/step.h"
#include "recording/rows/laser_radar_file.h"
#include "schedules/model/ports.h"

namespace ttf::nodes {

// Every step there is, with its ports.
std::span<const schedules::StepPorts> step_ports();

struct NodeSetConfig {
  const Scenario* scenario = nullptr;
  const schedules::Cluster* cluster = nullptr;
  fusion::StrategyKind strategy{};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const recording::RecordedInput> recorded;  // for clusters with recorded sources
};

// The code of a node's tasks, in file order. Throws InputError where the schedule's names and the code's do not agree.
std::vector<std::shared_ptr<Step>> make_steps(const NodeSetConfig& config, NodeId node);

// Whether the cluster takes its observations from a recording.
bool is_recorded(const schedules::Cluster& cluster);

}  // namespace ttf::nodes
