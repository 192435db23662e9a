// The crank in real time: one node of a cluster, driven by the clock of its host, on a medium that carries its frames
// to the other nodes' processes.
//
// The node lives in its own microticks, as it does in virtual time: everything is done at the instant it is due, one
// thing after the other, and what it tells the node's code and its controller are these instants. What the kernel is
// late by comes on top: outputs and frames leave later than they are due. That is measured at every wake-up and
// departure, counted where it is more than the arrival window allows, and never taken out of what is told. A process
// that was stopped catches up: its node does all it missed, in order, but sends nothing that is too late. One that
// has missed for too long what its clock goes by halts, as FlexRay has it (gMaxWithoutClockCorrectionFatal), and its
// host starts it anew: it integrates. So it does with one that may only listen for others, and hears nobody.
//
// Arrivals are known by the instants at which they reached the host, so that they need no wake-up of their own, but for
// those that a task waits for. Steps run on the same thread: one that computes for longer than it is until the next
// slot makes that late, which is counted like any lateness.
//
// Times in records: true time is when something was done, by the host's clock (nodes/runner/drive_clock.h); local and
// global time are when it was due. But for ClockCorrected, which tells what the clocks showed at one instant.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "nodes/host/executive.h"
#include "nodes/runner/arrival_window.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/live_flexray.h"
#include "nodes/runner/machine_clock.h"
#include "nodes/runner/paced_can.h"
#include "nodes/runner/timing_account.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"
#include "timebase/oscillator.h"

namespace ttf::nodes::runner {

struct RunnerConfig {
  const schedules::model::Cluster* cluster = nullptr;  // with an arrival window
  NodeId node{};
  DriveClock clock{{}, 1'000'000};
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  TrueTime first_cycle{};            // of who begins integrated; off FlexRay, of its power-on
  std::optional<TrueTime> power_on;  // it begins cold, then or at once if that is over
  host::NodeStart cold{};
  TrueTime end{};            // what is due later is not done
  int stop_descriptor = -1;  // readable: stop now
};

// How it goes, for people: in real time since the run began.
struct Health {
  TimingCounts timing;
  bus::ports::LiveCounts medium;
  std::uint64_t dropped = 0;  // frames that no room was for in this process, on their way in or out
  Duration wakeup_p50{}, wakeup_p99{}, wakeup_longest{};
  Duration largest_offset{};  // that clock synchronisation corrected, either sign
  std::string_view state;     // of the controller; empty off FlexRay

  // Frames that this process or its medium knows to have been lost, each once. Which of timing.frames_lost, known by
  // their gaps, are among them cannot be told, nor which their senders withheld.
  std::uint64_t drops() const { return medium.lost + medium.not_sent + dropped; }
};

enum class RunnerEnd : std::uint8_t {
  kDone,     // the drive is over
  kStopped,  // by the stop descriptor
  kFailed,   // the medium is of no use any more: LiveMedium::failure()
};

class Runner final : private host::SensorLines, private host::TrueClock, private ArrivalEvents {
 public:
  // All must outlive it.
  Runner(const RunnerConfig& config, std::vector<std::shared_ptr<host::Step>> steps, bus::ports::LiveMedium& medium,
         MachineClock& machine_clock, recording::records::Sink& sink);
  ~Runner() override;

  // About once a second of real time, where nothing is due at once.
  void on_health(std::function<void(const Health&)> hear) { on_health_ = std::move(hear); }
  RunnerEnd run();

  Health health() const;
  const host::ExecutiveCounts& counts() const { return executive_->counts(); }
  const TimingAccount& timing() const { return account_; }

 private:
  class Watch;

  TrueTime now() const override { return config_.clock.drive_time(machine_clock_.now()); }
  void trigger(SensorId sensor) override;
  void strobe(SensorId sensor, std::uint32_t sequence) override;
  void arrived(Microticks behind) override;
  void missed_window(std::int64_t cycle, int slot, schedules::model::Channel channel, Microticks behind) override;
  void lost(std::int64_t cycle, int slot, schedules::model::Channel channel, std::uint32_t count) override;

  const timebase::CycleClock* schedule() const;
  Microticks ticks(TrueTime at) const { return oscillator_.ticks_at(at); }
  Microticks ticks(Duration drive) const;
  Duration in_real(Microticks ticks) const;
  bus::ports::MachineTime machine_time(Microticks at) const {
    return config_.clock.machine_time(oscillator_.time_of(at));
  }

  void take_in();
  void do_due(Microticks now);
  // What a host does: a controller that has halted is started anew, and one whose coldstart attempts are exhausted when
  // it has listened for kCyclesUntilAnew: where all nodes only listen for others nobody would ever start the cluster.
  void look_after_controller();
  void hand_over(const ArrivalWindow::Due& due);
  void leave(std::size_t can_bus);
  Microticks next_due() const;
  void watch_lines();
  bus::ports::MachineTime next_health(bus::ports::MachineTime now) const;
  bus::ports::MachineTime tell_health();
  std::uint64_t dropped() const;
  void record_account();

  const RunnerConfig config_;
  const schedules::model::Cluster& cluster_;
  const timebase::Oscillator oscillator_;
  bus::ports::LiveMedium& medium_;
  MachineClock& machine_clock_;
  std::unique_ptr<Watch> watch_;  // the sink, with what is seen on the way to it
  TimingAccount account_;
  ArrivalWindow arrival_window_;
  LiveFlexRay flexray_;
  std::vector<std::unique_ptr<PacedCan>> cans_;         // by CAN, null where the node is not on it
  std::vector<std::optional<std::size_t>> sensor_can_;  // by sensor, the CAN of its lines
  std::unique_ptr<host::Executive> executive_;
  bus::ports::MachineTime powered_on_{std::numeric_limits<std::int64_t>::min()};
  Microticks last_{};                                                 // what was done last
  bool listens_ = false;                                              // FlexRay lines are watched
  Microticks tries_again_{std::numeric_limits<std::int64_t>::max()};  // at a coldstart, if it still may only listen
  bus::ports::MachineTime health_due_{};
  std::function<void(const Health&)> on_health_;
};

}  // namespace ttf::nodes::runner
