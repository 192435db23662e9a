// Writes a cluster's schedule as text: the cycle, the slots with their senders, and the tasks with their
// instants.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange {

// Returns several lines of at most 100 columns, unless a word is longer. Consecutive slots with the fragments of one list share a
// line. The cluster must have passed check().
std::string show_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::exchange
