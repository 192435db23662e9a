// A cluster's schedule as a picture: one communication cycle with the static slots of both channels (who
// sends what), the dynamic segment, the symbol window and the network idle time, the nodes' time-activated
// tasks below it, and the multiplexing of slots over cycles as a matrix.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::report::plots {

std::string schedule_svg(const schedules::model::Cluster& cluster);

}  // namespace ttf::report::plots
