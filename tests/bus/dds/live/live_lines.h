// Lines for tests: two channels with all members, a CAN without the last of more than two, and a CAN FD.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bus/dds/live/line.h"

namespace ttf::bus::dds::live {

inline std::vector<LiveLinePlan> live_lines(std::size_t members) {
  std::vector<NodeId> all;
  for (std::size_t i = 0; i < members; ++i) all.push_back(NodeId{static_cast<std::uint8_t>(i)});
  std::vector<NodeId> some = all;
  if (members > 2) some.pop_back();
  return {{0, live_topic(schedules::model::Channel::kA), all},
          {1, live_topic(schedules::model::Channel::kB), all},
          {2, live_can_topic("laser-can"), some},
          {3, live_can_topic("gateway"), all}};
}

inline bool is_on(const LiveLinePlan& plan, NodeId node) {
  return std::find(plan.nodes.begin(), plan.nodes.end(), node) != plan.nodes.end();
}

inline std::vector<LiveLinePlan> lines_of(const std::vector<LiveLinePlan>& plans, NodeId node) {
  std::vector<LiveLinePlan> own;
  for (const LiveLinePlan& plan : plans)
    if (is_on(plan, node)) own.push_back(plan);
  return own;
}

}  // namespace ttf::bus::dds::live
