// The lateness of wake-ups in a drive in real time, node by node, beside a plain periodic thread on the same machine.
// Each curve gives the share of wake-ups that were later than a number of microseconds. Both axes are logarithmic, so
// that one in ten thousand shows as well as the median. A curve ends at a mark on the longest lateness.
#pragma once

#include <map>
#include <string>

#include "core/ids.h"
#include "recording/exports/lateness_sums.h"
#include "report/drawing/names.h"

namespace ttf::report::plots {

// Draws the floors of all nodes as one curve. Without any recorded wake-up, the picture says so.
std::string lateness_svg(const std::map<NodeId, recording::exports::NodeLateness>& nodes, const drawing::Names& names,
                         const drawing::Sheet& sheet = {});

}  // namespace ttf::report::plots
