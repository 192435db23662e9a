// FlexRay controllers without hosts on the simulated bus: what start-up, clock synchronisation and faults do to a
// cluster, thousands of times over. Single-threaded, and a pure function of its configuration.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "sim/crank/crank_of.h"
#include "timebase/oscillator.h"

namespace ttf::sim::crank {

// One entry per node of the cluster; all must be on FlexRay.
struct BusNode {
  timebase::Oscillator oscillator;
  TrueTime power_on{};
  // A node that begins integrated, with its supply from the start; `power_on` is not read then.
  std::optional<bus::controller::InitialClock> clock{};
  // The schedule that this node believes in, with the same nodes and PDUs; null: the cluster's.
  const schedules::model::Cluster* view = nullptr;
};

class BusSimulation final : public CrankOf<bus::controller::FlexRayController> {
 public:
  // `events`: one per node, told what its controller tells a host. `guardians`: the oscillators of a star's two, else
  // without drift. They begin integrated if some node does.
  BusSimulation(const schedules::model::Cluster& cluster, std::vector<BusNode> nodes,
                std::vector<bus::controller::ControllerEvents*> events,
                const std::vector<timebase::Oscillator>& guardians = {});
  ~BusSimulation() override;

  // Of a node without supply: in default config.
  bus::controller::FlexRayController& controller(NodeId node) { return *nodes_[index_of(node)]; }
  // The largest difference between the global times of the nodes that are synchronised, now, from node `first` on.
  // Their cycle numbers may differ by whole rounds of the cycle counter; only the rest counts.
  Duration precision(NodeId first = NodeId{0}) const;

 private:
  void start(std::size_t node, Microticks now) override;
  void stop(std::size_t node) override;
  void happen(const medium::MediumEvent& event) override;
  void make_controller(std::size_t node);

  std::vector<const schedules::model::Cluster*> views_;  // these all by NodeId
  std::vector<bus::controller::ControllerEvents*> events_;
  std::vector<std::unique_ptr<CrankPort>> ports_;
};

}  // namespace ttf::sim::crank
