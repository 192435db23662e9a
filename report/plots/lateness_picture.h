// How late the processes of a run in real time were woken up, node by node, next to a plain periodic thread on the same
// machine: how many of the wake-ups were later than so many microseconds, both axes logarithmic, so that the one in ten
// thousand shows as well as the median. A curve ends at the longest of all, marked.
#pragma once

#include <map>
#include <string>

#include "core/ids.h"
#include "recording/exports/lateness_sums.h"
#include "report/drawing/names.h"

namespace ttf::report::plots {

// The floors of all nodes are one curve. A picture that says so where no node told of any wake-up.
std::string lateness_svg(const std::map<NodeId, recording::exports::NodeLateness>& nodes, const drawing::Names& names);

}  // namespace ttf::report::plots
