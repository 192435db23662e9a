// What must hold between clusters and FIBEX files.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::fuzz {

// A consistent cluster is the same after export and import, in what FIBEX can say, and nothing of it is left
// out or assumed.
void check_fibex_round_trip(const schedules::model::Cluster& cluster);

// Any text that claims to be FIBEX: refused as it should, or it becomes a cluster file that loads as what was
// imported, and stays the same on another way through FIBEX.
void check_fibex(const std::string& text);

}  // namespace ttf::fuzz
