// The exchange between a launch's processes in virtual time: the same for the supervisor and all nodes.
#pragma once

#include <chrono>

#include "cli/live_media/dds_session.h"
#include "cli/node_set/node_set.h"

namespace ttf::cli::node_set {

// All processes start at about the same time, by a supervisor or by hand on several machines.
inline constexpr std::chrono::milliseconds kOthersPatience{30'000};

inline bus::dds::common::Session session_of(const NodeSet& set, bool supervised) {
  return live_media::session_of(set.session, set.cluster, supervised);
}

}  // namespace ttf::cli::node_set
