// One node of a drive in virtual time, in a process of its own among others: its drive, its log, and what it tells of
// it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "bus/ports/exchange.h"
#include "cli/drive/drive_setup.h"
#include "core/ids.h"
#include "drives/drive.h"
#include "drives/scenario.h"
#include "fusion/strategies/strategy.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::node_set {

struct NodeDrive {
  const drives::Scenario* scenario = nullptr;
  const schedules::model::Cluster* cluster = nullptr;
  fusion::strategies::StrategyKind strategy{};
  std::uint64_t seed = 0;
  const drive::Recording* recording = nullptr;
  NodeId node{};
  std::string log_path;
};

// Runs it to its end. Throws std::runtime_error where the exchange fails or the log cannot be written.
drives::DriveOutcome run_node_drive(const NodeDrive& drive, bus::ports::Exchange& exchange);

// What a node has counted, on its way from its process to whoever started it; added up there. Throws
// std::runtime_error on what no counts_json() made.
nlohmann::ordered_json counts_json(const nodes::host::ExecutiveCounts& counts);
void add_counts(nodes::host::ExecutiveCounts& sum, const nlohmann::json& one);

// An outcome on its way from a node's process to whoever started it: what is the node's alone (its counts), and what
// all of them see alike (loads, faults).
nlohmann::ordered_json outcome_json(const drives::DriveOutcome& outcome);
// Adds up what the nodes say, of which `one` is the next. Throws std::runtime_error on what no outcome_json() made.
void add_outcome(drives::DriveOutcome& sum, const nlohmann::json& one);

}  // namespace ttf::cli::node_set
