// The whole cluster in virtual time: one executive per node, the media between them, and true time, which only this
// room knows. A run is a pure function of its configuration (sim/crank/crank.h).
//
// A node that loses its supply loses everything: its executive is dropped, and at power-on a new one is made, with
// steps made anew. A CAN frame whose sender or receiver was without supply at any time since it began does not arrive;
// the bus is taken to its end all the same.
//
// Or one node of it, the others being simulated by processes of their own (sim/processes/turn_taking.h): then the
// others' executives are not here, and of what they record nothing is.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "nodes/host/executive.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "sim/crank/clock_spread.h"
#include "sim/crank/crank_of.h"
#include "sim/medium/can_medium.h"
#include "sim/medium/channel_log.h"
#include "sim/processes/turn_taking.h"

namespace ttf::sim::crank {

// The instant at which cycle 0 starts, give or take the nodes' initial phases; where nodes start up, time zero of that.
inline constexpr TrueTime kFirstCycle{1'000'000};

struct SimulationConfig {
  const schedules::model::Cluster* cluster = nullptr;
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  // The code of a node's tasks, in file order. Asked at the start, and again at every power-on.
  std::function<std::vector<std::shared_ptr<nodes::host::Step>>(ttf::NodeId)> make_steps;
  // When the node is powered on, cold. Nothing, or no function: it begins integrated, and off FlexRay as if powered on
  // at kFirstCycle.
  std::function<std::optional<TrueTime>(ttf::NodeId)> power_on = {};
  // How a node begins that is powered on for the first time. No function: it starts up at once, as it does every other
  // time.
  std::function<nodes::host::NodeStart(ttf::NodeId)> cold = {};
  // The schedule that the node believes in, with the same nodes, tasks, PDUs and CANs. Null, or no function: the
  // cluster's.
  std::function<const schedules::model::Cluster*(ttf::NodeId)> view = {};
  // Null: all nodes are simulated here. Else make_steps is asked for the own node only.
  processes::TurnTaking* others = nullptr;
  // False: nobody wants to know precision(), nor to have it recorded. Everything else is as it is.
  bool compares_clocks = true;
};

class ClusterSimulation final : public CrankOf<nodes::host::Executive>, private nodes::host::SensorLines {
 public:
  ClusterSimulation(const SimulationConfig& config, recording::records::Sink& sink);
  ~ClusterSimulation() override;

  // The achieved precision so far: the largest difference between any two nodes' global times at one true instant, but
  // for whole rounds of the cycle counter (sim/crank/clock_spread.h). The difference is piecewise linear with corners
  // at the nodes' cycle starts and correction starts; it is taken there. Zero, and never recorded, where there is but
  // one node.
  Duration precision() const { return precision_; }
  // Of a node with supply, simulated here.
  const nodes::host::Executive& node(NodeId id) const;
  // Summed over the nodes simulated here, those that have lost their supply included.
  nodes::host::ExecutiveCounts counts() const;
  Duration can_busy(std::size_t bus) const { return cans_[bus]->busy(); }
  std::uint64_t frames_sent() const { return frames_sent_; }  // on FlexRay, each channel's
  // How long the busier channel has been taken.
  Duration flexray_busy() const {
    return std::max(medium_.busy(schedules::model::Channel::kA), medium_.busy(schedules::model::Channel::kB));
  }

 private:
  // What observations look at, of one node.
  struct Watch {
    const bus::controller::FlexRayController* controller = nullptr;  // null where the node is none, or off FlexRay
    const timebase::Oscillator* crystal = nullptr;
    std::int64_t cycle = -1;  // whose corners are being observed

    // Null while it has none.
    const timebase::CycleClock* clock() const { return controller ? controller->synchronised_clock() : nullptr; }
  };
  struct FlexRayTap;
  struct CanTap;
  struct CanLog;

  void start(std::size_t node, Microticks now) override;
  void stop(std::size_t node) override;
  Microticks next_event(std::size_t node) const override;
  void advance(std::size_t node, Microticks now) override;
  void receive(std::size_t node, const bus::ports::Reception& reception) override;
  bool receive_on_both(std::size_t node, const bus::ports::Reception& reception) override;
  void drifts(std::size_t node) override;
  void happen(const medium::MediumEvent& event) override;

  void trigger(SensorId sensor) override;
  void strobe(SensorId sensor, std::uint32_t sequence) override;
  bool is_here(std::size_t node) const { return others_ == nullptr || others_->self() == static_cast<NodeId>(node); }
  void take_turn(std::size_t node, Microticks now);
  void act(std::size_t node, const processes::Act& act);
  void transmit(std::size_t node, const bus::ports::Transmission& transmission);
  void send_can(std::size_t bus, NodeId sender, const bus::ports::CanFrame& frame) {
    cans_[bus]->send(sender, now(), frame);
  }
  void pull_trigger(SensorId sensor);
  void pull_strobe(SensorId sensor, std::uint32_t sequence);
  void make_guardians();
  void make_node(std::size_t node, std::optional<bus::controller::InitialClock> clock, Microticks power_on,
                 const nodes::host::NodeStart& cold);
  bool arrives(const medium::MediumEvent& event) const;
  void observe();
  void watch_cycle(std::size_t node, const timebase::CycleClock& clock);
  void schedule_observation(std::size_t node, TrueTime at);

  const SimulationConfig config_;
  processes::TurnTaking* const others_;
  recording::records::Sink& sink_;
  std::optional<medium::ChannelLog> channel_log_;  // where somebody wants frames
  std::vector<std::unique_ptr<medium::CanMedium>> cans_;
  std::vector<std::unique_ptr<FlexRayTap>> flexray_taps_;  // by NodeId, null off FlexRay
  std::vector<std::unique_ptr<CanTap>> can_taps_;
  std::vector<std::vector<bus::ports::CanPort*>> can_ports_;  // by NodeId and CAN, null where it is not on it
  std::unique_ptr<CanLog> can_log_;
  std::vector<Watch> watches_;  // by NodeId
  const ClockSpread no_spread_;
  nodes::host::ExecutiveCounts gone_;  // counted by executives that are no more
  Duration precision_{};
  Duration precision_of_pair_{};
  std::int64_t reported_pair_ = 0;
  std::uint64_t frames_sent_ = 0;
};

}  // namespace ttf::sim::crank
