// One node at work: its controllers, its CNI buffers and its tasks, driven from outside in its own microticks.
//
// The executive obeys one law under every crank: a task reads its inputs when it starts, and its outputs become visible
// at its end. One processor, no preemption; tasks activated while it is busy wait, and an activation that meets a still
// waiting one of the same task is an overrun, counted.
//
// A sensor that follows its host is triggered when the host's task ends, unless that has been activated again already:
// one list is on its way at a time, also after one was lost and the device has measured by itself.
//
// Waiting tasks start in order of their activation. Of those activated at one microtick the one that stands earlier in
// the file is first, whatever activated them: a message, the end of another task, an instant of the schedule or a
// sensor.
//
// At one microtick things happen in this order: arrivals (by the crank), ends of tasks, the bus controller,
// activations, starts. So what becomes visible at a tick is still sent or read at that tick. A sleeping node does
// nothing and hears nothing but a wake-up pattern.
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
#include "nodes/host/promise.h"
#include "nodes/host/step.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::host {

// The wires between a sensor and its host: a trigger to the device, a strobe back at the instant of measuring.
class SensorLines {
 public:
  virtual ~SensorLines() = default;
  virtual void trigger(SensorId sensor) = 0;
  virtual void strobe(SensorId sensor, std::uint32_t sequence) = 0;
};

// What an ideal observer's clock shows. In virtual time things happen when they are due, and the oscillator says when
// that is; in real time they happen later.
class TrueClock {
 public:
  virtual ~TrueClock() = default;
  virtual TrueTime now() const = 0;
};

struct ExecutiveConfig {
  const schedules::model::Cluster* cluster = nullptr;
  NodeId node{};
  timebase::Oscillator oscillator;
  std::optional<bus::controller::InitialClock>
      clock;               // of a node that begins integrated; else it starts up at power_on
  std::uint64_t seed = 0;  // of the execution times
  std::uint32_t replication = 0;
  Microticks power_on{};                  // free-running sensors count their phase from here, too
  ColdStart cold{};                       // of a node that does not begin integrated
  Duration boots{};                       // of a sleeping node: from the end of the wake-up pattern to its start-up
  const TrueClock* true_clock = nullptr;  // null: what is due happens
};

struct ExecutiveCounts {
  std::uint64_t overruns = 0;  // activations that met a waiting one
  std::uint64_t deadlines_missed = 0;
  std::uint64_t torn_lists = 0;  // displaced before they were complete
  std::uint64_t overwritten_lists = 0;
  std::uint64_t discarded_lists = 0;  // read, but their time of measuring is not known
  std::uint64_t slot_problems = 0;
  std::uint64_t saturated_signals = 0;
  std::uint64_t refused_fragments = 0;   // stale or malformed (bus/cni/list_buffer.h), on any bus
  std::uint64_t refused_can_frames = 0;  // not of the schedule (bus/cni/can_controller.h)
  std::uint64_t unlisted_fates = 0;      // of lists that no record tells of (fusion/strategies/strategy.h)
};

class Executive final : private bus::controller::ControllerEvents {
 public:
  // `steps`: one per task of the node, in file order. `flexray` may be null for a node off FlexRay; `cans` has one
  // entry per CAN of the cluster, null where this node is not on it.
  Executive(const ExecutiveConfig& config, std::vector<std::shared_ptr<Step>> steps, bus::ports::FlexRayPort* flexray,
            std::vector<bus::ports::CanPort*> cans, SensorLines& lines, recording::records::Sink& sink);
  ~Executive() override;

  Microticks next_event() const;
  void advance(Microticks now);
  // Holds until the next advance() with anything due, or the next arrival that it names. What the node does that others
  // notice, it does within advance().
  Promise promise() const;

  // Arrivals. `now` is the node's microtick of the arrival. What they set off happens at the next advance(), which
  // next_event() then asks for.
  void receive(const bus::ports::Reception& reception);
  // The same on both channels at once (bus/controller/controller.h). False: next_event() is what it was.
  bool receive_on_both(const bus::ports::Reception& reception);
  // What is on its way to its controller (bus/controller/controller.h).
  bool knows(const bus::ports::Reception& reception) { return !asleep_ && flexray_->knows(reception); }
  void hear_known(const bus::ports::Reception& reception) { flexray_->hear_known(reception); }
  void receive_can(std::size_t can_bus, const bus::ports::CanFrame& frame, Microticks now);
  // A frame of this node has left, `now`. `frame` is what the medium knows of it: bus, start, when it has left in true
  // time, identifier and data; the node reports it with its own clock's times and the list and measurement it is of.
  void can_frame_sent(recording::records::CanFrameSent frame, Microticks now);
  void trigger(SensorId sensor, Microticks now);                         // at a device
  void strobe(SensorId sensor, std::uint32_t sequence, Microticks now);  // at a host

  // The host has its controller begin anew, cold, where that has halted. What was to happen by the global time is lost.
  void start_anew(Microticks now);

  // The node's oscillator has changed its drift; its ticks so far are the same.
  void drift(const timebase::Oscillator& oscillator) { config_.oscillator = oscillator; }

  // It has not been woken yet.
  bool asleep() const { return asleep_; }
  // The node's clock of the cluster, null while it has none: off FlexRay, or before it has integrated.
  const timebase::CycleClock* clock() const { return flexray_ ? flexray_->synchronised_clock() : nullptr; }
  // Null off FlexRay.
  const bus::controller::FlexRayController* controller() const { return flexray_.get(); }
  const timebase::Oscillator& oscillator() const { return config_.oscillator; }
  recording::records::Stamp stamp(Microticks at) const;
  const ExecutiveCounts& counts() const { return counts_; }

 private:
  struct TaskState;
  struct SensorState;

  void list_arrived(PduId pdu, bus::cni::ArrivalEffect effect, std::uint32_t sequence,
                    std::optional<std::uint32_t> torn, Microticks at) override;
  bool wants_bytes() const override { return wants_frames_; }
  bool wants_receptions() const override { return false; }
  void frame_sent(const bus::ports::Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                  std::uint32_t sequence, int fragment, bool last) override {
    if (wants_frames_ || last) tell_of_frame(transmission, cycle, null_frame, pdu, sequence, fragment, last);
  }
  void tell_of_frame(const bus::ports::Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                     std::uint32_t sequence, int fragment, bool last);
  void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, bus::controller::SlotStatus status,
                    Microticks at) override;
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks at) override;
  void symbol_sent(bus::ports::Signal signal, schedules::model::Channel channel, Microticks start,
                   Microticks end) override;
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at) override;

  // What happens by the cluster's clock happens at other ticks now.
  void cycle_started(std::int64_t cycle, Microticks at) override {
    (void)cycle, (void)at;
    concerned_ = true;
  }
  void look_ahead();  // own_next_, whenever something has concerned it
  void arrived(PduId pdu, int can_bus, bus::cni::ArrivalEffect effect, std::uint32_t sequence,
               std::optional<std::uint32_t> torn, Microticks at);
  void rise(Microticks now);
  void start_up_after_waking(Microticks now);
  void arm_cycle();
  void activate_due(Microticks now);
  void activate(std::size_t task, Microticks now);
  void start_next(Microticks now);
  void finish(Microticks now);
  void measure(SensorState& sensor, Microticks now);
  // The shortest time from an arrival on that medium that activates a task to the task's end.
  Microticks soonest_end(bool on_can) const;
  void fill_inputs(TaskState& task);
  void identify(recording::records::CanFrameSent& frame) const;
  void hop(const recording::records::Stamp& at, recording::records::Hop what, PduId pdu, std::uint32_t sequence,
           int can_bus);
  bus::cni::IncomingList& incoming(const schedules::model::PortBinding& binding);
  Microticks ticks(Duration duration) const;

  ExecutiveConfig config_;
  const schedules::model::Cluster& cluster_;
  const schedules::model::Node& node_;
  SensorLines& lines_;
  recording::records::Sink& sink_;
  const bool wants_frames_;
  std::unique_ptr<bus::controller::FlexRayController> flexray_;
  std::vector<std::unique_ptr<bus::cni::CanController>> cans_;
  std::vector<TaskState> tasks_;
  std::vector<SensorState> sensors_;  // those this node is device or host of
  std::vector<StrobeLatch> strobes_;  // by SensorId
  std::vector<std::size_t> ready_;    // waiting tasks, by (activation, place in the file)
  std::optional<std::size_t> running_;
  Microticks running_end_{};
  std::int64_t armed_cycle_ = -1;
  bool concerned_ = true;  // own_next_ is to be looked for anew
  Microticks own_next_{};  // next_event() but for the controller's
  bool asleep_ = false;
  std::optional<Microticks> rises_;  // while asleep: when, once a wake-up pattern was heard
  bool waking_ = false;              // others: start-up comes after the wake-up
  ExecutiveCounts counts_;
};

}  // namespace ttf::nodes::host
