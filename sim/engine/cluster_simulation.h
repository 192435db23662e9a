// The whole cluster in virtual time: one executive per node, the media between them, and true time, which only
// this module has. A drive is a pure function of its configuration (sim/engine/engine.h).
//
// A node that loses its supply loses everything: its executive is dropped, and power-on makes a new one with
// new steps. Its frame on a CAN breaks off there (sim/medium/can_medium.h).
//
// With a process for each node (sim/processes/turn_taking.h), only the own node has its executive and its records here.
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
#include "sim/engine/clock_spread.h"
#include "sim/engine/engine_of.h"
#include "sim/medium/can_medium.h"
#include "sim/medium/channel_log.h"
#include "sim/processes/turn_taking.h"

namespace ttf::sim::engine {

// The start of cycle 0, up to the nodes' initial phases; with a start-up, its time zero.
inline constexpr TrueTime kFirstCycle{1'000'000};

struct SimulationConfig {
  const schedules::model::Cluster* cluster = nullptr;
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  // Makes the code of a node's tasks, in file order. Called at the start, and again at every power-on.
  std::function<std::vector<std::shared_ptr<nodes::host::Step>>(ttf::NodeId)> make_steps;
  // Returns when the node is powered on, cold. No value, or no function: the node begins integrated; off
  // FlexRay, as if powered on at kFirstCycle.
  std::function<std::optional<TrueTime>(ttf::NodeId)> power_on = {};
  // Returns how a node begins at its first power-on. No function: it starts up at once, as at every later power-on.
  std::function<nodes::host::NodeStart(ttf::NodeId)> cold = {};
  // Returns the schedule that the node believes in, with the same nodes, tasks, PDUs and CANs. Null, or no
  // function: the cluster's.
  std::function<const schedules::model::Cluster*(ttf::NodeId)> view = {};
  // Null: all nodes are simulated here. Otherwise make_steps is called for the own node only.
  processes::TurnTaking* others = nullptr;
  // False: precision() is neither computed nor recorded. All else stays the same.
  bool compares_clocks = true;
  // Takes in an actuation before the instant from which on it holds. No function: nothing happens.
  std::function<void(const nodes::host::Actuation&)> actuate = {};
  // The private CANs go bit by bit. The records stay the same.
  bool cans_bit_by_bit = false;
};

class ClusterSimulation final : public EngineOf<nodes::host::Executive>, private nodes::host::SensorLines {
 public:
  ClusterSimulation(const SimulationConfig& config, recording::records::Sink& sink);
  ~ClusterSimulation() override;

  // Returns the precision so far: the largest difference between two nodes' global times at one true instant, less
  // whole rounds of the cycle counter (sim/engine/clock_spread.h). The difference is piecewise linear with corners at
  // the nodes' cycle starts and correction starts, and is taken there. With one node it is zero, and never recorded.
  Duration precision() const { return precision_; }
  // Returns a node that has supply and is simulated here.
  const nodes::host::Executive& node(NodeId id) const;
  // Returns the sum over the nodes simulated here, with those that have lost their supply.
  nodes::host::ExecutiveCounts counts() const;
  Duration can_busy(std::size_t bus) const { return cans_[bus]->busy(); }
  medium::CanMedium* can(std::size_t bus) override { return cans_[bus].get(); }
  std::uint64_t frames_sent() const { return frames_sent_; }  // on FlexRay, counted per channel
  // Returns how long the busier channel has been in use.
  Duration flexray_busy() const {
    return std::max(medium_.busy(schedules::model::Channel::kA), medium_.busy(schedules::model::Channel::kB));
  }

 private:
  // The observed parts of one node.
  struct Watch {
    const bus::controller::FlexRayController* controller = nullptr;  // null without supply, or off FlexRay
    const timebase::Oscillator* crystal = nullptr;
    std::int64_t cycle = -1;  // the cycle whose corners are observed

    // Returns null while it has none.
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
  void disturbs_cans(medium::CanDisturbance* disturbance) override;
  void happen(const medium::MediumEvent& event) override;

  void trigger(SensorId sensor) override;
  void strobe(SensorId sensor, std::uint32_t sequence) override;
  void actuate(const nodes::host::Actuation& actuation) override;
  bool is_here(std::size_t node) const { return others_ == nullptr || others_->self() == static_cast<NodeId>(node); }
  void start_here(std::size_t node, Microticks now);
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
  void observe();
  void watch_cycle(std::size_t node, const timebase::CycleClock& clock);
  void schedule_observation(std::size_t node, TrueTime at);

  const SimulationConfig config_;
  processes::TurnTaking* const others_;
  recording::records::Sink& sink_;
  std::optional<medium::ChannelLog> channel_log_;  // if the sink wants frames
  std::vector<std::unique_ptr<medium::CanMedium>> cans_;
  std::vector<std::unique_ptr<FlexRayTap>> flexray_taps_;  // by NodeId, null off FlexRay
  std::vector<std::unique_ptr<CanTap>> can_taps_;
  std::vector<std::vector<bus::ports::CanPort*>> can_ports_;  // by NodeId and CAN, null where the node is not on it
  std::unique_ptr<CanLog> can_log_;
  std::vector<Microticks> first_cycle_;  // its start, by NodeId
  std::vector<Watch> watches_;           // by NodeId
  const ClockSpread no_spread_;
  nodes::host::ExecutiveCounts gone_;  // counts of executives that are gone
  Duration precision_{};
  Duration precision_of_pair_{};
  std::int64_t reported_pair_ = 0;
  TrueTime reported_from_{};  // the beginning of the newest actuation that another process reported
  std::uint64_t frames_sent_ = 0;
};

}  // namespace ttf::sim::engine
