// A cluster's schedule as a picture of one communication cycle: the static slots of both channels with
// senders and contents, the dynamic segment, the symbol window and the network idle time. Below are the
// nodes' time-activated tasks and a matrix of the multiplexing of slots over cycles.
#pragma once

#include <string>

#include "report/drawing/sheet.h"
#include "schedules/model/cluster.h"

namespace ttf::report::plots {

std::string schedule_svg(const schedules::model::Cluster& cluster, const drawing::Sheet& sheet = {});

}  // namespace ttf::report::plots
