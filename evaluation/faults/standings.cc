#include "evaluation/faults/standings.h"

#include <algorithm>

namespace ttf::evaluation::faults {

Standings::Standings(const schedules::model::Cluster& cluster, bool begins_integrated) : nodes_(cluster.nodes.size()) {
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    (begins_integrated ? nodes_[n].active : nodes_[n].has_to_start) = cluster.nodes[n].flexray.has_value();
}

bool Standings::all_fault_free_active() const {
  return std::all_of(nodes_.begin(), nodes_.end(), [](const Node& node) { return node.faulty || node.active; });
}

void Standings::becomes_active(NodeId node) {
  nodes_[index_of(node)].active = true;
  nodes_[index_of(node)].has_to_start = false;
}

}  // namespace ttf::evaluation::faults
