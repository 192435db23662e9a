#include "cli/node/live_bus.h"

#include <utility>

#include "bus/dds/live/medium.h"
#include "bus/socketcan/medium.h"
#include "cli/node_set/session.h"
#include "cli/output.h"

namespace ttf::cli::node {
namespace {

bool is_on(const schedules::model::Cluster& cluster, NodeId node, schedules::model::Channel channel) {
  const auto& flexray = cluster.node(node).flexray;
  return flexray && includes(flexray->pChannels, channel);
}

std::unique_ptr<bus::ports::LiveMedium> on_dds(const node_set::NodeSet& set, NodeId self,
                                               std::chrono::milliseconds patience) {
  std::vector<bus::dds::live::LiveLinePlan> lines;
  const auto add = [&](bus::ports::Line line, std::string topic, const auto& is_on_it) {
    bus::dds::live::LiveLinePlan plan{line, std::move(topic), {}};
    for (std::size_t n = 0; n < set.cluster.nodes.size(); ++n)
      if (is_on_it(static_cast<NodeId>(n))) plan.nodes.push_back(static_cast<NodeId>(n));
    if (is_on_it(self)) lines.push_back(std::move(plan));
  };
  for (const schedules::model::Channel channel : schedules::model::kBothChannels)
    add(bus::ports::line_of(channel), bus::dds::live::live_topic(channel),
        [&](NodeId node) { return is_on(set.cluster, node, channel); });
  for (std::size_t b = 0; b < set.cluster.can_buses.size(); ++b)
    add(bus::ports::line_of_can(b), bus::dds::live::live_can_topic(set.cluster.can_buses[b].name),
        [&](NodeId node) { return schedules::model::is_on_can(set.cluster.node(node), b); });
  auto medium = std::make_unique<bus::dds::live::DdsMedium>(session_of(set, false), self, lines);
  try {
    if (patience.count() > 0) medium->wait_ready(patience);
  } catch (const bus::dds::common::NotReady& missing) {
    print_warnings(std::string("goes on without those who are not there yet: ") + missing.what());
  }
  return medium;
}

std::unique_ptr<bus::ports::LiveMedium> on_socketcan(const node_set::NodeSet& set, NodeId self) {
  bus::socketcan::LiveOptions options;
  for (const schedules::model::Channel channel : schedules::model::kBothChannels)
    if (is_on(set.cluster, self, channel) && index_of(channel) < set.bus.interfaces.size())
      options.channels[index_of(channel)] = set.bus.interfaces[index_of(channel)];
  for (std::size_t b = 0; b < set.cluster.can_buses.size(); ++b) {
    const bool on_it = schedules::model::is_on_can(set.cluster.node(self), b);
    options.cans.push_back({on_it ? set.can_interfaces[b] : "", set.cluster.can_buses[b].flexible_data_rate});
  }
  auto medium = std::make_unique<bus::socketcan::SocketCanMedium>(options);
  print_warnings(medium->shortages());
  return medium;
}

}  // namespace

std::unique_ptr<bus::ports::LiveMedium> live_medium(const node_set::NodeSet& set, NodeId node,
                                                    std::chrono::milliseconds patience) {
  return set.bus.kind == supervision::BusKind::kDds ? on_dds(set, node, patience) : on_socketcan(set, node);
}

}  // namespace ttf::cli::node
