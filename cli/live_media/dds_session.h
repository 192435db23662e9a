// The DDS session of all nodes of a cluster.
#pragma once

#include <string>

#include "bus/dds/common/session.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::live_media {

inline bus::dds::common::Session session_of(const std::string& name, const schedules::model::Cluster& cluster,
                                            bool supervised) {
  bus::dds::common::Session session;
  session.name = name;
  session.supervised = supervised;
  for (std::size_t node = 0; node < cluster.nodes.size(); ++node) session.members.push_back(static_cast<NodeId>(node));
  return session;
}

}  // namespace ttf::cli::live_media
