// A real node's duties in words and as JSON (duties.h). Lines of text have at most 100 columns.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/launch/external/duties.h"
#include "cli/live_media/bus.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch::external {

// The interfaces of channels and of private CANs (NodeSet::can_interfaces), or the session of a bus without them.
struct DutyPlaces {
  const schedules::model::Cluster& cluster;
  const live_media::Bus& bus;
  const std::vector<std::string>& can_interfaces;
  const std::string& session;
};

std::string text_of(const Duties& duties, const DutyPlaces& places);
nlohmann::ordered_json json_of(const Duties& duties, const DutyPlaces& places);

}  // namespace ttf::cli::launch::external
