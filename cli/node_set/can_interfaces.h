// Which interface each private CAN of a cluster is on, where the live medium has interfaces.
#pragma once

#include <string>
#include <vector>

#include "cli/live_media/bus.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::node_set {

// By Cluster::can_buses: what --can NAME=IF says of it, or else an interface of the CAN's own name. Each CAN has an
// interface of its own, and none of the bus', as identifiers would get mixed up. Throws InputError for what is no
// interface's name, for interfaces that meet, for a CAN that is not in the cluster or is given twice, and for anything
// given where the medium has none; there the list is empty.
std::vector<std::string> can_interfaces(const schedules::model::Cluster& cluster, const live_media::Bus& bus,
                                        const std::vector<std::string>& given);

// --can options that give these interfaces again.
std::vector<std::string> can_options(const schedules::model::Cluster& cluster,
                                     const std::vector<std::string>& interfaces);

// What the preflight looks at.
std::vector<live_media::PrivateCan> private_cans(const schedules::model::Cluster& cluster,
                                                 const std::vector<std::string>& interfaces);

}  // namespace ttf::cli::node_set
