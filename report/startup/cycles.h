// Who led the start-up, and when its communication cycles began: what a start-up diagram's grid shows.
#pragma once

#include <map>
#include <optional>

#include "core/time.h"
#include "report/startup/data.h"

namespace ttf::report::startup {

struct LeadingNode {
  NodeId node{};
  TrueTime cas{};  // end of the collision avoidance symbol its cycles count from
};

// The node that first went from coldstart consistency check to normal active, else the one that sent the last collision
// avoidance symbol; nothing where there was none.
std::optional<LeadingNode> leading_node(const StartupData& data);

// Start of the leading node's cycles from 0 on and up to `end`. Cycle 0 starts with the end of the CAS (a macrotick
// later, to be exact). A later cycle is where the node's first frame of it says, which always has the same place in the
// cycle; where it sent none, a nominal cycle after the one before.
std::map<std::int64_t, TrueTime> cycles_of(const StartupData& data, const LeadingNode& leader, Duration cycle,
                                           TrueTime end);

}  // namespace ttf::report::startup
