// A node's ends of the lines between sensors and their hosts: when its devices measure, when its hosts trigger, and the
// strobes that a host latches.
//
// A sensor that follows its host is triggered when the host's task ends, unless that has been activated again already:
// one list is on its way at a time, also after one was lost and the device has measured by itself.
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

// The wires between a sensor and its host: a trigger to the device, a strobe back at the instant of measuring.
class SensorLines {
 public:
  virtual ~SensorLines() = default;
  virtual void trigger(SensorId sensor) = 0;
  virtual void strobe(SensorId sensor, std::uint32_t sequence) = 0;
};

// What phases are drawn by that the cluster leaves open.
struct PhaseKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

class SensorEnds {
 public:
  // `cluster`, `time` and `lines` outlive this.
  SensorEnds(const schedules::model::Cluster& cluster, NodeId node, const PhaseKey& key, const NodeTime& time,
             SensorLines& lines);

  void power_on(Microticks now);  // devices count their phase from here
  // The triggers of this cycle of the global time.
  void arm(std::int64_t cycle);
  void disarm();
  // Triggers and measures what is due. The measuring tasks to activate, until the next call.
  std::span<const std::size_t> act(Microticks now);
  Microticks next_event() const;  // for act()

  // A trigger has come to a device.
  void triggered(SensorId sensor, Microticks now);
  // A strobe has come to a host.
  void latch(SensorId sensor, std::uint32_t sequence, Microticks now);
  // Triggers what follows that task.
  void task_ended(std::size_t task);

  // Whether a trigger makes some device measure.
  bool any_triggered() const;
  // The number of the newest measurement that the task is to send; 0 for one that measures nothing.
  std::uint32_t measurement(std::size_t task) const;
  std::span<const StrobeLatch> strobes() const { return strobes_; }  // by SensorId

 private:
  struct Device {
    std::size_t task = 0;      // that measures
    bool runs_freely = false;  // else it follows, or time triggers it
    Duration phase{};          // but for those that time triggers: from power-on to the first measurement
    LocalTime first{};         // likewise: the instant of that
    std::uint32_t measured = 0;
    std::optional<Microticks> due;  // following or triggered: measures then, at the first act() from it on
    Microticks ready{};             // following: not before this
  };
  struct Host {
    bool armed = false;                // trigger still due in this cycle
    std::optional<std::size_t> after;  // of one that follows: the task whose end triggers
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
  std::vector<End> ends_;  // of those sensors that this node is device or host of
  std::vector<StrobeLatch> strobes_;
  std::vector<std::size_t> set_off_;
};

}  // namespace ttf::nodes::host
