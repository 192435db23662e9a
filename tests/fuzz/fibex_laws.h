// Laws between clusters and FIBEX files.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::fuzz {

// A consistent cluster is the same after export and import, in everything that FIBEX can express, without
// gaps or assumptions.
void check_fibex_round_trip(const schedules::model::Cluster& cluster);

// Any text as FIBEX is refused properly, or becomes a cluster file. The file loads as the imported cluster,
// and survives another pass through FIBEX.
void check_fibex(const std::string& text);

}  // namespace ttf::fuzz
