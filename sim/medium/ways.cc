#include "sim/medium/ways.h"

#include <algorithm>
#include <cstdlib>

namespace ttf::sim::medium {
namespace {

using schedules::model::Channel;

// Returns the ways to the attached nodes, with the delays of `delay_to`.
template <class DelayTo> Ways ways_to(const std::array<std::vector<NodeId>, 2>& attached, DelayTo delay_to) {
  Ways ways;
  for (std::size_t c = 0; c < ways.size(); ++c) {
    for (const NodeId node : attached[c])
      if (const std::optional<Duration> delay = delay_to(node)) ways[c].push_back({node, *delay});
    std::stable_sort(ways[c].begin(), ways[c].end(), [](const Leg& a, const Leg& b) { return a.delay < b.delay; });
  }
  return ways;
}

}  // namespace

FlexRayWays::FlexRayWays(const schedules::model::Cluster& cluster)
    : position_(cluster.nodes.size(), -1), star_(cluster.topology == schedules::model::Topology::kStar),
      min_delay_ps_(cluster.flexray.gdMinPropagationDelay_ps), max_delay_ps_(cluster.flexray.gdMaxPropagationDelay_ps),
      from_node_(cluster.nodes.size()) {
  std::array<std::vector<NodeId>, 2> attached;  // by channel
  int on_bus = 0;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (!cluster.nodes[n].flexray) continue;
    position_[n] = on_bus++;
    for (const Channel channel : {Channel::kA, Channel::kB})
      if (includes(cluster.nodes[n].flexray->pChannels, channel))
        attached[index_of(channel)].push_back(static_cast<NodeId>(n));
  }
  ends_ = on_bus - 1;
  same_on_both_ = attached[0] == attached[1];
  from_nowhere_ = ways_to(attached, [](NodeId) { return std::optional(Duration{}); });
  if (star_) from_coupler_ = ways_to(attached, [&](NodeId node) { return std::optional(branch(node)); });
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const auto sender = static_cast<NodeId>(n);
    if (is_on_bus(sender))
      from_node_[n] = ways_to(
          attached, [&](NodeId node) { return node == sender ? std::nullopt : std::optional(delay(sender, node)); });
  }
}

std::int64_t FlexRayWays::branch_ps(NodeId node) const {
  const int steps = ends_ - 1;  // to the two longest branches
  const std::int64_t range = max_delay_ps_ - min_delay_ps_;
  const std::int64_t longer = steps <= 0 ? range : range * std::min(position_[index_of(node)], steps) / steps;
  return (min_delay_ps_ + longer) / 2;
}

Duration FlexRayWays::branch(NodeId node) const { return {(branch_ps(node) + 999) / 1000}; }

Duration FlexRayWays::delay(NodeId from, NodeId to) const {
  if (ends_ <= 0) return {};
  if (star_) return {(branch_ps(from) + branch_ps(to) + 999) / 1000};
  const int hops = std::abs(position_[index_of(from)] - position_[index_of(to)]);
  const std::int64_t ps = min_delay_ps_ + (max_delay_ps_ - min_delay_ps_) * hops / ends_;
  return {(ps + 999) / 1000};
}

}  // namespace ttf::sim::medium
