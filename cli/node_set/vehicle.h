// The vehicle that commands drive, in real time: processes that need its state receive the commands beside the bus.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/node_set/node_set.h"
#include "nodes/runner/vehicle/line.h"
#include "sim/drives/surroundings.h"

namespace ttf::cli::node_set {

// Returns the line of a node's process; null if no commands drive the vehicle, or the node needs no state of it.
// `around` outlives the line.
std::unique_ptr<nodes::runner::vehicle::Line> vehicle_line(const NodeSet& set, NodeId node,
                                                           const sim::drives::Surroundings& around);
// Returns the line of a launch, which receives all nodes; null likewise.
std::unique_ptr<nodes::runner::vehicle::Line> vehicle_line_of_launch(const NodeSet& set,
                                                                     const sim::drives::Surroundings& around);
// For a process that joins a running drive: waits for the missed commands, and warns if they did not come.
void catch_up(nodes::runner::vehicle::Line& line);

nlohmann::ordered_json vehicle_json(const nodes::runner::vehicle::Counts& counts);
// Returns a sentence, without its subject, if the process saw the vehicle elsewhere than it was; else "". `json` is
// from vehicle_json(), of any process.
std::string vehicle_problem(const nlohmann::json& json);
// Warns of that, and of a node that received no command at all, at the end of a node without a launch.
void warn_of_vehicle(const NodeSet& set, NodeId node, const nodes::runner::vehicle::Counts& counts);

}  // namespace ttf::cli::node_set
