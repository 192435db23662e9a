// Readers and writers of a line. Only sources of this folder include it.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/qos.h"
#include "bus/dds/live/line.h"
#include "core/ids.h"

namespace ttf::bus::dds::live {

inline constexpr std::size_t kMostEndpoints = 256;  // on one line

// `owner` is the node to be named if it is missing; kNoNode for an endpoint that no node awaits.
common::Qos live_qualities(Delivery delivery, NodeId owner);

// Returns the nodes named by matched readers or writers.
std::vector<NodeId> owners(common::Handle entity, const std::vector<dds_instance_handle_t>& matched,
                           dds_builtintopic_endpoint_t* (*data)(dds_entity_t, dds_instance_handle_t));

}  // namespace ttf::bus::dds::live
