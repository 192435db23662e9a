// One node of a cluster as a process of its own.
#pragma once

#include <string>

#include "cli/node_set/node_set.h"
#include "core/ids.h"

namespace ttf::cli::node {

struct NodeOptions {
  node_set::NodeSet set;
  NodeId node{};
  std::string log;    // this node's alone
  bool json = false;  // prints the result as JSON on standard output
};

// Drives the node to the drive's end in virtual time, together with the others over set.bus, and returns the
// exit code. Reports to a supervisor, if present, over supervision::ControlLine. Throws InputError and
// std::runtime_error as commands do.
int run_node_virtual(const NodeOptions& options);
// Does the same in real time. A process signal or the loss of the supervisor ends it in order, with a complete log.
int run_node_live(const NodeOptions& options);

}  // namespace ttf::cli::node
