#include "evaluation/faults/standings.h"

#include <algorithm>
#include <utility>

namespace ttf::evaluation::faults {

Standings::Standings(const schedules::model::Cluster& cluster, bool begins_integrated) : nodes_(cluster.nodes.size()) {
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    (begins_integrated ? nodes_[n].active : nodes_[n].has_to_start) = cluster.nodes[n].flexray.has_value();
}

bool Standings::all_fault_free_active() const {
  return std::all_of(nodes_.begin(), nodes_.end(), [](const Node& node) { return node.faulty || node.active; });
}

bool Standings::leaves_by(const recording::records::StateChanged& change) {
  Node& node = nodes_[index_of(change.stamp.node)];
  const bool active = change.to == recording::records::PocKind::kNormalActive;
  if (active) node.has_to_start = false;
  return std::exchange(node.active, active) && !active;
}

bool Standings::leaves_by(const recording::records::PowerChanged& power) {
  return !power.on && std::exchange(nodes_[index_of(power.stamp.node)].active, false);
}

}  // namespace ttf::evaluation::faults
