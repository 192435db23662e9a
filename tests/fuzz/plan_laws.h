// Laws of a plan: it is refused in lines, has no solution, or becomes a cluster that passes the check. The cluster's ages are
// within the plan's limits, and no value is better than its bound. Written and read again, the cluster is the same.
#pragma once

#include <string>

namespace ttf::fuzz {

// Tries the first few lengths of the cycle and periods alone, and plans of two sensors at most: each input takes milliseconds.
void check_plan(const std::string& text);

}  // namespace ttf::fuzz
