// The leader of a start-up and its communication cycles, for the grid of a start-up diagram.
#pragma once

#include <map>
#include <optional>

#include "core/time.h"
#include "report/startup/data.h"

namespace ttf::report::startup {

struct LeadingNode {
  NodeId node{};
  TrueTime cas{};  // end of the collision avoidance symbol from which its cycles count
};

// Returns the node that first went from coldstart consistency check to normal active. Otherwise returns the
// sender of the last collision avoidance symbol, or no value without a symbol.
std::optional<LeadingNode> leading_node(const StartupData& data);

// Returns the starts of the leading node's cycles from 0 on, up to `end`. Cycle 0 starts at the end of the
// CAS (exactly, a macrotick later). The node's first frame of a later cycle gives its start, as its place in
// the cycle is fixed. Without a frame a cycle starts one nominal cycle after the one before.
std::map<std::int64_t, TrueTime> cycles_of(const StartupData& data, const LeadingNode& leader, Duration cycle,
                                           TrueTime end);

}  // namespace ttf::report::startup
