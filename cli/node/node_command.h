// One node of a cluster as a process of its own.
#pragma once

#include <string>

#include "cli/node_set/node_set.h"
#include "core/ids.h"

namespace ttf::cli::node {

struct NodeOptions {
  node_set::NodeSet set;
  NodeId node{};
  std::string log;    // the node's own
  bool json = false;  // what came of it as JSON on standard output
};

// Drives the node to the drive's end in virtual time, together with the others over set.bus; its exit code. A
// supervisor, where there is one, is spoken to over launch::ControlLine. Throws InputError and std::runtime_error as
// commands do.
int run_node_virtual(const NodeOptions& options);
// The same in real time. A signal, or a supervisor that has gone, ends it in order: the log is complete up to there.
int run_node_live(const NodeOptions& options);

}  // namespace ttf::cli::node
