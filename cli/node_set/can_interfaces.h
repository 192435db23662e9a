// Chooses the interface of each private CAN of a cluster, if the live medium has interfaces.
#pragma once

#include <string>
#include <vector>

#include "cli/live_media/bus.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::node_set {

// Returns the interfaces by Cluster::can_buses: from --can NAME=IF, or else the interface of the CAN's own
// name. Each CAN has an interface of its own, apart from the bus, so that identifiers stay distinct. For a
// medium without interfaces the list is empty. Throws InputError for an invalid interface name, a shared
// interface, a CAN that is unknown or given twice, and any --can for a medium without interfaces.
std::vector<std::string> can_interfaces(const schedules::model::Cluster& cluster, const live_media::Bus& bus,
                                        const std::vector<std::string>& given);

// Returns --can options for these interfaces.
std::vector<std::string> can_options(const schedules::model::Cluster& cluster,
                                     const std::vector<std::string>& interfaces);

// Returns the private CANs for the preflight.
std::vector<live_media::PrivateCan> private_cans(const schedules::model::Cluster& cluster,
                                                 const std::vector<std::string>& interfaces);

}  // namespace ttf::cli::node_set
