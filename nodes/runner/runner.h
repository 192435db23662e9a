// The engine in real time: drives one node of a cluster by the machine's clock, on a medium that carries its
// frames to the processes of the other nodes.
//
// The node lives in its own microticks, as in virtual time. Everything is done at the instant it is due, one
// thing after the other, and the node's code and controller receive these instants. The kernel's lateness comes
// on top: outputs and frames leave later than they are due. Lateness is measured at every wake-up and
// departure, counted where it exceeds the arrival window, and never corrected in the records. A stopped process
// catches up: its node does all it missed, in order, but sends nothing that is too late. A node without clock
// corrections for too long halts (gMaxWithoutClockCorrectionFatal); its host starts it anew, and it integrates.
// The host also starts a node anew that may only listen for others and receives no frame.
//
// Arrivals have the instants at which they reached the machine. So they need no wake-up of their own, except
// those that a task waits for. Steps run on the same thread. A step that computes beyond the start of the next
// slot delays it, which is counted like any lateness.
//
// Times in records: true time is when something was done, by the machine's clock (nodes/runner/drive_clock.h); local
// and global time are when it was due. ClockCorrected is the exception: it says what the clocks showed at one instant.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/poc/poc.h"
#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "nodes/host/executive.h"
#include "nodes/runner/arrival_window.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/live_flexray.h"
#include "nodes/runner/machine_clock.h"
#include "nodes/runner/paced_can.h"
#include "nodes/runner/timing_account.h"
#include "nodes/runner/vehicle/line.h"
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
  TrueTime first_cycle{};            // for a node that begins integrated; off FlexRay, its power-on
  std::optional<TrueTime> power_on;  // begins cold, then or at once if that time has passed
  host::NodeStart cold{};
  TrueTime end{};            // events due later are not done
  int stop_descriptor = -1;  // stops as soon as it is readable
  // Leads to the other processes that need the vehicle's state; null if no commands drive it, or this one needs none.
  vehicle::Line* vehicle = nullptr;
};

// How a run goes, for people: in real time since its begin.
struct Health {
  TimingCounts timing;
  bus::ports::LiveCounts medium;
  std::uint64_t dropped = 0;  // frames without room in this process, inbound or outbound
  Duration wakeup_p50{}, wakeup_p99{}, wakeup_longest{};
  Duration largest_offset{};               // the largest correction by clock synchronisation, either sign
  std::optional<bus::poc::PocKind> state;  // the controller's; none off FlexRay
  // Its interfaces to private CANs report error frames, and their controllers' states. The worst present state is unknown
  // before the first report.
  std::uint64_t can_errors = 0;
  std::optional<recording::records::CanState> can_state;
  std::optional<vehicle::Counts> vehicle;  // its line's

  // Counts each frame once that this process or its medium has found to be lost. timing.frames_lost counts gaps:
  // some of those may be the same frames, others were withheld by their senders.
  std::uint64_t drops() const { return medium.lost + medium.not_sent + dropped; }
};

enum class RunnerEnd : std::uint8_t {
  kDone,     // the drive is over
  kStopped,  // by the stop descriptor
  kFailed,   // the medium has failed: LiveMedium::failure()
};

class Runner final : private host::SensorLines, private host::TrueClock, private ArrivalEvents {
 public:
  // The arguments outlive this.
  Runner(const RunnerConfig& config, std::vector<std::shared_ptr<host::Step>> steps, bus::ports::LiveMedium& medium,
         MachineClock& machine_clock, recording::records::Sink& sink);
  ~Runner() override;

  // Calls `receiver` about once a second of real time, in a moment when nothing is due at once.
  void on_health(std::function<void(const Health&)> receiver) { on_health_ = std::move(receiver); }
  RunnerEnd run();

  Health health() const;
  const host::ExecutiveCounts& counts() const { return executive_->counts(); }
  const TimingAccount& timing() const { return account_; }

 private:
  class Watch;

  TrueTime now() const override { return config_.clock.drive_time(machine_clock_.now()); }
  void trigger(SensorId sensor) override;
  void strobe(SensorId sensor, std::uint32_t sequence) override;
  void actuate(const host::Actuation& actuation) override;
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
  void report_errors(const bus::ports::LiveArrival& arrival);
  void do_due(Microticks now);
  // Does a host's work: restarts a halted controller. It also restarts one whose coldstart attempts are
  // exhausted, after kCyclesUntilAnew of listening: if all nodes only listened, the cluster would never start.
  void look_after_controller();
  void hand_over(const ArrivalWindow::Due& due);
  void leave(std::size_t can_bus);
  Microticks next_due() const;
  void watch_lines();
  bus::ports::MachineTime next_health(bus::ports::MachineTime now) const;
  bus::ports::MachineTime report_health();
  std::uint64_t dropped() const;
  void record_account();

  const RunnerConfig config_;
  const schedules::model::Cluster& cluster_;
  const timebase::Oscillator oscillator_;
  bus::ports::LiveMedium& medium_;
  MachineClock& machine_clock_;
  std::unique_ptr<Watch> watch_;  // the sink, with a view on its records
  TimingAccount account_;
  ArrivalWindow arrival_window_;
  LiveFlexRay flexray_;
  std::vector<std::unique_ptr<PacedCan>> cans_;           // by CAN, null where the node is not on it
  std::vector<recording::records::CanState> can_states_;  // by CAN: of the own controller, as its interface reports it
  std::uint64_t can_errors_ = 0;
  bool can_reported_ = false;
  std::vector<std::optional<std::size_t>> sensor_can_;  // by sensor, the CAN of its lines
  std::unique_ptr<host::Executive> executive_;
  bus::ports::MachineTime powered_on_{std::numeric_limits<std::int64_t>::min()};
  Microticks last_{};                                                 // the instant of the last thing done
  bool listens_ = false;                                              // FlexRay lines are watched
  Microticks tries_again_{std::numeric_limits<std::int64_t>::max()};  // at a coldstart, if it still may only listen
  bus::ports::MachineTime health_due_{};
  std::function<void(const Health&)> on_health_;
};

}  // namespace ttf::nodes::runner
