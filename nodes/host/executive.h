// One node at work: its controllers, its CNI buffers and its tasks, driven from outside in its own microticks.
//
// One law holds under every engine: a task reads its inputs at its start, and its outputs become visible at its
// end. The parts are the operating system, which runs tasks (nodes/host/processor.h), the wiring, which moves
// lists (nodes/host/wiring.h), the sensor ends, which trigger and measure (nodes/host/sensor_ends.h), and the
// node's records (nodes/host/node_records.h).
//
// At one microtick the order is: arrivals (by the engine), ends of tasks, the bus controller, activations,
// starts. So an output that becomes visible at a tick is still sent or read at that tick. A sleeping node does
// nothing, and receives only a wake-up pattern.
//   L1  after advance(t) and without further arrivals, next_event() is after t
//   L2  nothing allocates or throws after construction; only the failing step of a library throws (nodes/foreign)
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bus/cni/can_controller.h"
#include "bus/controller/controller.h"
#include "bus/ports/can_port.h"
#include "core/ids.h"
#include "nodes/host/cold_start.h"
#include "nodes/host/executive_counts.h"
#include "nodes/host/node_records.h"
#include "nodes/host/node_time.h"
#include "nodes/host/processor.h"
#include "nodes/host/promise.h"
#include "nodes/host/sensor_ends.h"
#include "nodes/host/step.h"
#include "nodes/host/wiring.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::host {

struct ExecutiveConfig {
  const schedules::model::Cluster* cluster = nullptr;
  NodeId node{};
  timebase::Oscillator oscillator;
  // The clock of a node that begins integrated; without it, the node starts up at power_on.
  std::optional<bus::controller::InitialClock> clock;
  std::uint64_t seed = 0;  // for the execution times
  std::uint32_t replication = 0;
  Microticks power_on{};                  // free-running sensors also count their phase from here
  ColdStart cold{};                       // for a node that does not begin integrated
  Duration boots{};                       // for a sleeping node: from the end of the wake-up pattern to its start-up
  const TrueClock* true_clock = nullptr;  // null: events happen when they are due
  // The start of the first cycle, from which Sensor::instants count; absent: power_on. After a restart they differ.
  std::optional<Microticks> first_cycle{};
};

class Executive final : private bus::controller::ControllerEvents {
 public:
  // `steps` has one step per task of the node, in file order. `flexray` may be null for a node off FlexRay.
  // `cans` has one entry per CAN of the cluster, null where this node is not on it.
  Executive(const ExecutiveConfig& config, std::vector<std::shared_ptr<Step>> steps, bus::ports::FlexRayPort* flexray,
            const std::vector<bus::ports::CanPort*>& cans, SensorLines& lines, recording::records::Sink& sink);

  Microticks next_event() const;
  void advance(Microticks now);
  // Returns a promise that holds until the next advance() with anything due, or until the next arrival that it
  // names. All acts that others notice happen within advance().
  Promise promise() const;

  // Take arrivals in. `now` is the node's microtick of the arrival. Its effects follow at the next advance(),
  // for which next_event() then asks.
  void receive(const bus::ports::Reception& reception);
  // Takes in one frame on both channels at once (bus/controller/controller.h). False: next_event() is unchanged.
  // tests/sim/processes/unwanted_frames_test.cc compares whole drives with and without it.
  bool receive_on_both(const bus::ports::Reception& reception);
  // For a reception that is still on its way to the controller (bus/controller/controller.h).
  bool is_known(const bus::ports::Reception& reception) { return !asleep_ && flexray_->is_known(reception); }
  void receive_known(const bus::ports::Reception& reception) { flexray_->receive_known(reception); }
  void receive_can(std::size_t can_bus, const bus::ports::CanFrame& frame, Microticks now);
  // Records that a frame of this node left at `now`. `frame` has the medium's knowledge: bus, start, true time of
  // the departure, identifier and data. The node adds the times of its own clock, the list and the measurement.
  void can_frame_sent(const recording::records::CanFrameSent& frame, Microticks now);
  void trigger(SensorId sensor, Microticks now);                         // reaches a device
  void strobe(SensorId sensor, std::uint32_t sequence, Microticks now);  // reaches a host

  // Starts a halted controller anew, cold. Losing global time cancels what it scheduled.
  void start_anew(Microticks now);

  // Changes the oscillator's drift; its ticks so far stay the same.
  void drift(const timebase::Oscillator& oscillator) { time_.drift(oscillator); }

  bool asleep() const { return asleep_; }
  // Returns the node's clock of the cluster, or null while it has none: off FlexRay, or before it has integrated.
  const timebase::CycleClock* clock() const { return time_.global(); }
  // Null off FlexRay.
  const bus::controller::FlexRayController* controller() const { return flexray_.get(); }
  const timebase::Oscillator& oscillator() const { return time_.oscillator(); }
  recording::records::Stamp stamp(Microticks at) const { return time_.stamp(at); }
  const ExecutiveCounts& counts() const { return records_.counts(); }

 private:
  // The controller's events become records. A changed clock moves all events that are due by it.
  void cycle_started(std::int64_t, Microticks) override { concerned_ = true; }
  void list_arrived(PduId pdu, bus::cni::ArrivalEffect effect, std::uint32_t sequence,
                    std::optional<std::uint32_t> torn, Microticks at) override {
    arrived({schedules::model::kFlexRay, pdu, effect, sequence, torn}, at);
  }
  bool wants_bytes() const override { return records_.wants_frames(); }
  bool wants_receptions() const override { return false; }
  void frame_sent(const bus::ports::Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                  std::uint32_t sequence, int fragment, bool last) override {
    if (last || records_.wants_frames())
      records_.frame_sent(transmission, cycle, null_frame, pdu, sequence, fragment, last);
  }
  void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, bus::controller::SlotStatus status,
                    Microticks at) override {
    records_.slot_problem(cycle, slot, channel, status, at);
  }
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks at) override {
    concerned_ = true;
    records_.clock_corrected(cycle, offset, rate, at);
  }
  void symbol_sent(bus::ports::Signal signal, schedules::model::Channel channel, Microticks start,
                   Microticks end) override {
    records_.symbol_sent(signal, channel, start, end);
  }
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) override {
    concerned_ = true;
    records_.state_changed(from, step, at);
  }

  std::vector<Connection> connect(bus::ports::FlexRayPort* flexray, const std::vector<bus::ports::CanPort*>& cans);
  void look_ahead();  // computes own_next_ anew
  void arrived(const ListArrival& arrival, Microticks at);
  void power_on(Microticks now);
  void start_up_after_waking(Microticks now);
  void arm_cycle();
  void start_next(Microticks now);
  void run_step(const Processor::Running& running);
  void finish(Microticks now);
  // Returns the shortest time from an arrival on that kind of medium to the end of a task that it activates.
  Microticks soonest_end(bool on_can) const;

  const ExecutiveConfig config_;
  const schedules::model::Node& node_;
  const std::vector<std::shared_ptr<Step>> steps_;  // by task
  NodeTime time_;
  NodeRecords records_;
  std::unique_ptr<bus::controller::FlexRayController> flexray_;
  std::vector<std::unique_ptr<bus::cni::CanController>> cans_;  // by CAN of the cluster
  Wiring wiring_;
  Processor processor_;
  SensorEnds sensors_;
  SensorLines& lines_;
  std::optional<Actuation> actuation_;  // the running task's
  std::int64_t armed_cycle_ = -1;
  bool concerned_ = true;  // own_next_ must be computed anew
  Microticks own_next_{};  // next_event() without the controller's
  bool asleep_;
  std::optional<Microticks> rises_;  // while asleep: the power-on that a wake-up pattern has set
  bool waking_ = false;              // it wakes others, and starts up afterwards
};

}  // namespace ttf::nodes::host
