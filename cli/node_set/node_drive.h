// One node of a drive in virtual time as one process among others: its drive, its log and its results.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "bus/ports/exchange.h"
#include "cli/drive/drive_setup.h"
#include "core/ids.h"
#include "fusion/strategies/strategy.h"
#include "schedules/model/cluster.h"
#include "sim/drives/drive.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::node_set {

struct NodeDrive {
  const sim::drives::Scenario* scenario = nullptr;
  const schedules::model::Cluster* cluster = nullptr;
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  const drive::Recording* recording = nullptr;
  const nodes::foreign::StepFolder* steps = nullptr;
  NodeId node{};
  std::string log_path;
};

// Runs the drive to its end. Throws std::runtime_error if the exchange fails or the log cannot be written.
sim::drives::DriveOutcome run_node_drive(const NodeDrive& drive, bus::ports::Exchange& exchange);

// Convert a node's counts on the way from its process to the launch, which adds them up. add_counts() throws
// std::runtime_error for JSON of another form.
nlohmann::ordered_json counts_json(const nodes::host::ExecutiveCounts& counts);
void add_counts(nodes::host::ExecutiveCounts& sum, const nlohmann::json& one);

// Converts an outcome on that way: the node's own part (its counts), and the part common to all (loads, faults).
nlohmann::ordered_json outcome_json(const sim::drives::DriveOutcome& outcome);
// Adds `one` to the sum of the nodes. Throws std::runtime_error for JSON of another form.
void add_outcome(sim::drives::DriveOutcome& sum, const nlohmann::json& one);

}  // namespace ttf::cli::node_set
