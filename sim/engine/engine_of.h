// The engine over nodes of one kind with the functions of FlexRayController: controllers alone
// (sim/engine/bus_simulation.h) or whole executives (sim/engine/cluster_simulation.h).
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "sim/engine/engine.h"

namespace ttf::sim::engine {

template <class Node> class EngineOf : public Engine {
 protected:
  EngineOf(const schedules::model::Cluster& cluster, std::size_t others)
      : Engine(cluster, others), nodes_(cluster.nodes.size()) {}

  Microticks next_event(std::size_t node) const override { return nodes_[node]->next_event(); }
  void advance(std::size_t node, Microticks now) override { nodes_[node]->advance(now); }
  void receive(std::size_t node, const bus::ports::Reception& reception) override { nodes_[node]->receive(reception); }
  bool receive_on_both(std::size_t node, const bus::ports::Reception& reception) override {
    return nodes_[node]->receive_on_both(reception);
  }
  bool is_known(std::size_t node, const bus::ports::Reception& reception) final {
    return nodes_[node]->is_known(reception);
  }
  void receive_known(std::size_t node, const bus::ports::Reception& reception) final {
    nodes_[node]->receive_known(reception);
  }

  std::vector<std::unique_ptr<Node>> nodes_;  // by NodeId; null without supply or elsewhere
};

}  // namespace ttf::sim::engine
