// The real-time medium that a node set's command line names.
#pragma once

#include <chrono>
#include <memory>

#include "bus/ports/live_medium.h"
#include "cli/node_set/node_set.h"
#include "core/ids.h"

namespace ttf::cli::node {

// Of that node: with the FlexRay channels that it is attached to, and the CANs that it is on. Throws InputError where
// what the command line names is not there, std::runtime_error where the medium does not start.
// On DDS, where nobody is heard at once, the others are waited for, so long at most; who is missing then is warned of.
std::unique_ptr<bus::ports::LiveMedium> live_medium(const node_set::NodeSet& set, NodeId node,
                                                    std::chrono::milliseconds patience);

}  // namespace ttf::cli::node
