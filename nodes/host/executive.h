// One node at work: its controllers, its CNI buffers and its tasks, driven from outside in its own microticks.
//
// The executive obeys one law under every crank: a task reads its inputs when it starts, and its outputs become visible
// at its end. It has three parts: the operating system says who runs when (nodes/host/processor.h), the wiring which
// list goes where (nodes/host/wiring.h), the record keeping what is told of it (nodes/host/node_records.h);
// nodes/host/sensor_ends.h says when sensors are triggered and measure.
//
// At one microtick things happen in this order: arrivals (by the crank), ends of tasks, the bus controller,
// activations, starts. So what becomes visible at a tick is still sent or read at that tick.
// A sleeping node does nothing and hears nothing but a wake-up pattern.
//   L1  after advance(t) and without further arrivals, next_event() is after t
//   L2  nothing allocates or throws after construction
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
  // Of a node that begins integrated; else it starts up at power_on.
  std::optional<bus::controller::InitialClock> clock;
  std::uint64_t seed = 0;  // of the execution times
  std::uint32_t replication = 0;
  Microticks power_on{};                  // free-running sensors count their phase from here, too
  ColdStart cold{};                       // of a node that does not begin integrated
  Duration boots{};                       // of a sleeping node: from the end of the wake-up pattern to its start-up
  const TrueClock* true_clock = nullptr;  // null: what is due happens
};

class Executive final : private bus::controller::ControllerEvents {
 public:
  // `steps`: one per task of the node, in file order. `flexray` may be null for a node off FlexRay; `cans` has one
  // entry per CAN of the cluster, null where this node is not on it.
  Executive(const ExecutiveConfig& config, std::vector<std::shared_ptr<Step>> steps, bus::ports::FlexRayPort* flexray,
            const std::vector<bus::ports::CanPort*>& cans, SensorLines& lines, recording::records::Sink& sink);

  Microticks next_event() const;
  void advance(Microticks now);
  // Holds until the next advance() with anything due, or the next arrival that it names. What the node does that others
  // notice, it does within advance().
  Promise promise() const;

  // Arrivals. `now` is the node's microtick of the arrival. What they set off happens at the next advance(), which
  // next_event() then asks for.
  void receive(const bus::ports::Reception& reception);
  // The same on both channels at once (bus/controller/controller.h). False: next_event() is what it was. The
  // test compares whole drives with and without it (tests/sim/processes/unwanted_frames_test.cc).
  bool receive_on_both(const bus::ports::Reception& reception);
  // What is on its way to its controller (bus/controller/controller.h).
  bool knows(const bus::ports::Reception& reception) { return !asleep_ && flexray_->knows(reception); }
  void hear_known(const bus::ports::Reception& reception) { flexray_->hear_known(reception); }
  void receive_can(std::size_t can_bus, const bus::ports::CanFrame& frame, Microticks now);
  // A frame of this node has left, `now`. `frame` is what the medium knows of it: bus, start, when it has left in true
  // time, identifier and data; the node reports it with its own clock's times and the list and measurement it is of.
  void can_frame_sent(const recording::records::CanFrameSent& frame, Microticks now);
  void trigger(SensorId sensor, Microticks now);                         // at a device
  void strobe(SensorId sensor, std::uint32_t sequence, Microticks now);  // at a host

  // The host has its controller begin anew, cold, where that has halted. What was to happen by the global time is lost.
  void start_anew(Microticks now);

  // The node's oscillator has changed its drift; its ticks so far are the same.
  void drift(const timebase::Oscillator& oscillator) { time_.drift(oscillator); }

  // It has not been woken yet.
  bool asleep() const { return asleep_; }
  // The node's clock of the cluster, null while it has none: off FlexRay, or before it has integrated.
  const timebase::CycleClock* clock() const { return time_.global(); }
  // Null off FlexRay.
  const bus::controller::FlexRayController* controller() const { return flexray_.get(); }
  const timebase::Oscillator& oscillator() const { return time_.oscillator(); }
  recording::records::Stamp stamp(Microticks at) const { return time_.stamp(at); }
  const ExecutiveCounts& counts() const { return records_.counts(); }

 private:
  // What the controller tells becomes records. What happens by the cluster's clock happens at other ticks now where
  // that has changed.
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
  void look_ahead();  // own_next_, whenever something has concerned it
  void arrived(const ListArrival& arrival, Microticks at);
  void power_on(Microticks now);
  void start_up_after_waking(Microticks now);
  void arm_cycle();
  void start_next(Microticks now);
  void run_step(const Processor::Running& running);
  void finish(Microticks now);
  // The shortest time from an arrival on that kind of medium that activates a task to the task's end.
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
  std::int64_t armed_cycle_ = -1;
  bool concerned_ = true;  // own_next_ is to be looked for anew
  Microticks own_next_{};  // next_event() but for the controller's
  bool asleep_;
  std::optional<Microticks> rises_;  // while asleep: when, once a wake-up pattern was heard
  bool waking_ = false;              // others: start-up comes after the wake-up
};

}  // namespace ttf::nodes::host
