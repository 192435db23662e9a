// FlexRay controllers without hosts on the simulated bus: what start-up, clock synchronisation and faults do to a cluster,
// thousands of times over. Single-threaded, and a pure function of its configuration.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bus/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/cluster.h"
#include "sim/flexray_medium.h"
#include "timebase/oscillator.h"

namespace ttf::sim {

// One entry per node of the cluster; all must be on FlexRay.
struct BusNode {
  timebase::Oscillator oscillator;
  TrueTime power_on{};
};

class BusSimulation {
 public:
  // `events`: one per node, told what its controller tells a host.
  BusSimulation(const schedules::Cluster& cluster, std::vector<BusNode> nodes,
                std::vector<bus::ControllerEvents*> events);
  ~BusSimulation();

  // Everything up to and including `end`.
  void run_until(TrueTime end);

  TrueTime now() const { return now_; }
  bus::FlexRayController& controller(NodeId node) { return *controllers_[index_of(node)]; }
  const timebase::Oscillator& oscillator(NodeId node) const { return nodes_[index_of(node)].oscillator; }
  FlexRayMedium& medium() { return medium_; }
  // Null: nothing goes wrong.
  void set_disturbance(Disturbance* disturbance);
  // The node loses its supply: nothing of it is left until it is powered on again (from `at` on).
  void power_off(NodeId node);
  void power_on(NodeId node, TrueTime at);
  // The largest difference between the global times of the nodes that are synchronised, now, from node `first` on. Their
  // cycle numbers may differ by whole rounds of the cycle counter; only the rest counts.
  Duration precision(NodeId first = NodeId{0}) const;

 private:
  struct Port;
  void refresh(std::size_t node);
  void step_node(std::size_t node);
  void deliver(const MediumEvent& event);

  const schedules::Cluster& cluster_;
  std::vector<BusNode> nodes_;
  std::vector<bus::ControllerEvents*> events_;
  MediumQueue queue_;
  FramePool pool_;
  FlexRayMedium medium_;
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<std::unique_ptr<bus::FlexRayController>> controllers_;
  std::vector<bool> powered_;
  std::vector<TrueTime> next_;      // per node, its next own event
  Disturbance* disturbance_ = nullptr;
  TrueTime now_{};
};

}  // namespace ttf::sim
