// The exchange that a launch's processes talk over in virtual time: the same for the supervisor and all nodes.
#pragma once

#include <chrono>

#include "bus/dds/common/session.h"
#include "cli/node_set/node_set.h"

namespace ttf::cli::node_set {

// Everybody is started at about the same time, by a supervisor or by hand on several hosts.
inline constexpr std::chrono::milliseconds kOthersPatience{30'000};

inline bus::dds::common::Session session_of(const NodeSet& set, bool supervised) {
  bus::dds::common::Session session;
  session.name = set.session;
  session.supervised = supervised;
  for (std::size_t node = 0; node < set.cluster.nodes.size(); ++node)
    session.members.push_back(static_cast<NodeId>(node));
  return session;
}

}  // namespace ttf::cli::node_set
