// FlexRay controllers without hosts on the simulated bus, for thousands of runs of start-up, clock
// synchronisation and faults. Single-threaded, and a pure function of its configuration.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bus/controller/controller.h"
#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"
#include "sim/engine/engine_of.h"
#include "timebase/oscillator.h"

namespace ttf::sim::engine {

// One per node of the cluster; all must be on FlexRay.
struct BusNode {
  timebase::Oscillator oscillator;
  TrueTime power_on{};
  // A node that begins integrated, with its supply from the start; it ignores `power_on`.
  std::optional<bus::controller::InitialClock> clock{};
  // The schedule that this node believes in, with the same nodes and PDUs; null: the cluster's.
  const schedules::model::Cluster* view = nullptr;
};

class BusSimulation final : public EngineOf<bus::controller::FlexRayController> {
 public:
  // `events` has one entry per node, for the events of its controller. `guardians` are the oscillators of a
  // star's two guardians; without them, these have no drift. The guardians begin integrated if some node does.
  BusSimulation(const schedules::model::Cluster& cluster, std::vector<BusNode> nodes,
                std::vector<bus::controller::ControllerEvents*> events,
                const std::vector<timebase::Oscillator>& guardians = {});
  ~BusSimulation() override;

  // Returns a node's controller; without supply it is in default config.
  bus::controller::FlexRayController& controller(NodeId node) { return *nodes_[index_of(node)]; }
  // Returns the largest difference between the global times of the synchronised nodes now, from node `first`
  // on. Whole rounds of the cycle counter do not count: cycle numbers may differ by them.
  Duration precision(NodeId first = NodeId{0}) const;

 private:
  void start(std::size_t node, Microticks now) override;
  void stop(std::size_t node) override;
  void happen(const medium::MediumEvent& event) override;
  void make_controller(std::size_t node);

  std::vector<const schedules::model::Cluster*> views_;  // all of these by NodeId
  std::vector<bus::controller::ControllerEvents*> events_;
  std::vector<std::unique_ptr<EnginePort>> ports_;
};

}  // namespace ttf::sim::engine
