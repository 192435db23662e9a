// One node of a drive in virtual time, in a process of its own among others: its drive, its log, and what it tells of
// it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "bus/ports/exchange.h"
#include "cli/drive/drive_setup.h"
#include "core/ids.h"
#include "fusion/strategies/strategy.h"
#include "drives/scenario.h"
#include "schedules/model/cluster.h"
#include "drives/drive.h"

namespace ttf::cli {

struct NodeDrive {
  const nodes::Scenario* scenario = nullptr;
  const schedules::Cluster* cluster = nullptr;
  fusion::StrategyKind strategy{};
  std::uint64_t seed = 0;
  const Recording* recording = nullptr;
  NodeId node{};
  std::string log_path;
};

// Runs it to its end. Throws std::runtime_error where the exchange fails or the log cannot be written.
sim::DriveOutcome run_node_drive(const NodeDrive& drive, bus::Exchange& exchange);

// What a node has counted, on its way from its process to whoever started it; added up there. Throws
// std::runtime_error on what no counts_json() made.
nlohmann::ordered_json counts_json(const nodes::ExecutiveCounts& counts);
void add_counts(nodes::ExecutiveCounts& sum, const nlohmann::json& one);

// An outcome on its way from a node's process to whoever started it: what is the node's alone (its counts), and what
// all of them see alike (loads, faults).
nlohmann::ordered_json outcome_json(const sim::DriveOutcome& outcome);
// Adds up what the nodes say, of which `one` is the next. Throws std::runtime_error on what no outcome_json() made.
void add_outcome(sim::DriveOutcome& sum, const nlohmann::json& one);

}  // namespace ttf::cli
