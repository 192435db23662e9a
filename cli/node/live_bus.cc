#include "cli/node/live_bus.h"

#include <utility>

#include "bus/dds/live/medium.h"
#include "bus/socketcan/live_medium.h"
#include "cli/node_set/session.h"
#include "cli/output.h"

namespace ttf::cli {
namespace {

bool is_on(const schedules::Cluster& cluster, NodeId node, schedules::Channel channel) {
  const auto& flexray = cluster.node(node).flexray;
  return flexray && includes(flexray->pChannels, channel);
}

std::unique_ptr<bus::LiveMedium> on_dds(const NodeSet& set, NodeId self, std::chrono::milliseconds patience) {
  std::vector<dds::LiveLinePlan> lines;
  const auto add = [&](bus::Line line, std::string topic, const auto& is_on_it) {
    dds::LiveLinePlan plan{line, std::move(topic), {}};
    for (std::size_t n = 0; n < set.cluster.nodes.size(); ++n)
      if (is_on_it(static_cast<NodeId>(n))) plan.nodes.push_back(static_cast<NodeId>(n));
    if (is_on_it(self)) lines.push_back(std::move(plan));
  };
  for (const schedules::Channel channel : schedules::kBothChannels)
    add(bus::line_of(channel), dds::live_topic(channel),
        [&](NodeId node) { return is_on(set.cluster, node, channel); });
  for (std::size_t b = 0; b < set.cluster.can_buses.size(); ++b)
    add(bus::line_of_can(b), dds::live_can_topic(set.cluster.can_buses[b].name),
        [&](NodeId node) { return schedules::is_on_can(set.cluster.node(node), b); });
  auto medium = std::make_unique<dds::LiveMedium>(session_of(set, false), self, lines);
  try {
    if (patience.count() > 0) medium->wait_ready(patience);
  } catch (const dds::NotReady& missing) {
    print_warnings(std::string("goes on without those who are not there yet: ") + missing.what());
  }
  return medium;
}

std::unique_ptr<bus::LiveMedium> on_socketcan(const NodeSet& set, NodeId self) {
  socketcan::LiveOptions options;
  for (const schedules::Channel channel : schedules::kBothChannels)
    if (is_on(set.cluster, self, channel) && index_of(channel) < set.bus.interfaces.size())
      options.channels[index_of(channel)] = set.bus.interfaces[index_of(channel)];
  for (std::size_t b = 0; b < set.cluster.can_buses.size(); ++b) {
    const bool on_it = schedules::is_on_can(set.cluster.node(self), b);
    options.cans.push_back({on_it ? set.can_interfaces[b] : "", set.cluster.can_buses[b].flexible_data_rate});
  }
  auto medium = std::make_unique<socketcan::LiveMedium>(options);
  print_warnings(medium->shortages());
  return medium;
}

}  // namespace

std::unique_ptr<bus::LiveMedium> live_medium(const NodeSet& set, NodeId node, std::chrono::milliseconds patience) {
  return set.bus.kind == launch::BusKind::kDds ? on_dds(set, node, patience) : on_socketcan(set, node);
}

}  // namespace ttf::cli
