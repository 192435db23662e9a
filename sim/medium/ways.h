// Distances between nodes on the simulated FlexRay, and the ways of signals.
//
// A linear bus has its nodes equally spaced along it. The propagation delay between two of them grows from
// gdMinPropagationDelay (neighbours at no distance) to gdMaxPropagationDelay (the two ends). A star has every node on
// a branch of its own, from half gdMinPropagationDelay for the first to half gdMaxPropagationDelay for the last two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::sim::medium {

struct Leg {
  NodeId receiver{};
  Duration delay{};
};
using Way = std::vector<Leg>;     // to all nodes attached to a channel; by (delay, receiver)
using Ways = std::array<Way, 2>;  // by channel

class FlexRayWays {
 public:
  explicit FlexRayWays(const schedules::model::Cluster& cluster);

  std::size_t nodes() const { return position_.size(); }  // in the cluster
  std::size_t nodes_on_bus() const { return static_cast<std::size_t>(ends_ + 1); }
  bool is_on_bus(NodeId node) const { return position_[index_of(node)] >= 0; }
  // Returns whether both channels have the same nodes.
  bool same_on_both() const { return same_on_both_; }

  Duration delay(NodeId from, NodeId to) const;
  // Returns the delay of a star's branch: from the node to the coupler, or back.
  Duration branch(NodeId node) const;
  // Returns the ways to all other nodes.
  const Ways& from(NodeId sender) const { return from_node_[index_of(sender)]; }
  // Returns the ways to all nodes at once.
  const Ways& from_nowhere() const { return from_nowhere_; }
  // Returns the ways from a star's middle to all nodes.
  const Ways& from_coupler() const { return from_coupler_; }

 private:
  std::int64_t branch_ps(NodeId node) const;

  std::vector<int> position_;  // by NodeId, -1 off the bus
  int ends_ = 0;               // hops between the two ends of the line
  bool star_;
  std::int64_t min_delay_ps_, max_delay_ps_;
  bool same_on_both_ = true;
  std::vector<Ways> from_node_;  // by NodeId
  Ways from_nowhere_, from_coupler_;
};

}  // namespace ttf::sim::medium
