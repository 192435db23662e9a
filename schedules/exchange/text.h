// A cluster's schedule as text: the cycle, who sends what in which slot, and when which task runs.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange {

// Several lines, at most about 100 columns. Consecutive slots with the fragments of one list share a line. The cluster
// must have passed check().
std::string show_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::exchange
