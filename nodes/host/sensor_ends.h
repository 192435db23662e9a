// A node's ends of the lines between sensors and their hosts: its devices measure, its hosts trigger and latch strobes.
//
// A sensor that follows its host is triggered when the host's task ends, unless that task is already activated
// again. So one list at a time is on its way, even after a lost list and a measurement without trigger.
//
// Nothing allocates or throws after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "nodes/host/node_time.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

// The wires between a sensor and its host: a trigger to the device, a strobe back at the instant of measurement. Where commands
// drive the vehicle, those from the actuator to it, too.
class SensorLines {
 public:
  virtual ~SensorLines() = default;
  virtual void trigger(SensorId sensor) = 0;
  virtual void strobe(SensorId sensor, std::uint32_t sequence) = 0;
  virtual void actuate(const Actuation& actuation) { (void)actuation; }
};

// The key from which phases are drawn that the cluster leaves open.
struct PhaseKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

class SensorEnds {
 public:
  // `cluster`, `time` and `lines` outlive this.
  SensorEnds(const schedules::model::Cluster& cluster, NodeId node, const PhaseKey& key, const NodeTime& time,
             SensorLines& lines);

  // Devices count their phase from now on. Those with listed instants go on with the next one since `first_cycle`.
  void power_on(Microticks now, Microticks first_cycle);
  // Arms the triggers of this cycle of the global time.
  void arm(std::int64_t cycle);
  void disarm();
  // Triggers and measures all that is due. Returns the measuring tasks to activate; they are valid until the next call.
  std::span<const std::size_t> act(Microticks now);
  Microticks next_event() const;  // the next instant for act()

  // Takes in a trigger at a device.
  void triggered(SensorId sensor, Microticks now);
  // Takes in a strobe at a host.
  void latch(SensorId sensor, std::uint32_t sequence, Microticks now);
  // Triggers the sensors that follow that task.
  void task_ended(std::size_t task);

  // Returns whether a trigger makes any device measure.
  bool any_triggered() const;
  // Returns the number of the newest measurement for the task to send; 0 if the task measures nothing.
  std::uint32_t measurement(std::size_t task) const;
  std::span<const StrobeLatch> strobes() const { return strobes_; }  // by SensorId

 private:
  struct Device {
    std::size_t task = 0;      // the measuring task
    bool runs_freely = false;  // otherwise it follows its host, or time triggers it
    Duration phase{};          // from power-on to the first measurement; zero for time-triggered devices
    LocalTime first{};         // the instant of the first measurement
    std::uint32_t measured = 0;
    std::optional<Microticks> due;  // following or triggered: measures at the first act() from then on
    Microticks ready{};             // following: not earlier than this
  };
  struct Host {
    bool armed = false;                // a trigger is still due in this cycle
    std::optional<std::size_t> after;  // for a sensor that follows: the task whose end triggers it
  };
  struct End {
    SensorId id{};
    const schedules::model::Sensor* sensor = nullptr;
    std::optional<Device> device;
    std::optional<Host> host;
  };
  Microticks next_by_itself(const End& end) const;
  void measure(End& end, Microticks now);

  const NodeTime& time_;
  SensorLines& lines_;
  std::vector<End> ends_;  // the sensors with this node as device or host
  std::vector<StrobeLatch> strobes_;
  std::vector<std::size_t> set_off_;
};

}  // namespace ttf::nodes::host
