// The instants of the schedule on which a list or a task's output rests, and the longest time from each of them until it is there.
// Between the instants are executions that lists activate and transfers on CANs, with the bounds of schedules/analysis.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/left_out/tasks.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::left_out {

// A place of the schedule's own: a scheduled sensor's measurement, a task that time activates, or a list's slots.
struct SchedulePlace {
  enum class Kind : std::uint8_t { kMeasurement, kTask, kSlots };
  Kind kind{};
  SensorId sensor = kNoSensor;
  TaskId task{};
  PduId list = kNoPdu;
  auto operator<=>(const SchedulePlace&) const = default;
};

// So long behind the place's beginning, or behind the end of a list's last slot; as any other clock may measure it, without the
// difference between clocks.
struct Source {
  SchedulePlace place;
  std::int64_t ns = 0;
};

class Sources {
 public:
  // The cluster must outlive the object.
  explicit Sources(const model::Cluster& cluster);

  // Returns the sources of a task's output: to the end of the task. None if no place of the schedule decides when it begins.
  std::vector<Source> ready(TaskId id) const { return ready(id, 0); }
  // Returns the sources of a list: until its readers have it whole. A list in the dynamic segment has its slots, too.
  std::vector<Source> arrival(PduId pdu, model::MediumId medium) const { return arrival(pdu, medium, 0); }

 private:
  std::vector<Source> ready(TaskId id, int hops) const;
  std::vector<Source> arrival(PduId pdu, model::MediumId medium, int hops) const;
  std::int64_t span(Duration worst) const;
  Duration response(TaskId id) const;

  const model::Cluster& cluster_;
  analysis::ClockBounds clocks_;
};

using Ticks = std::int64_t;  // macroticks

// Returns a duration in macroticks, rounded up.
Ticks ticks(const model::GlobalParameters& flexray, std::int64_t ns);

// Returns the last static slot that may be in use: late frames of real-time media arrive within the static segment
// (schedules/check/real_time_rules.h, W2).
Ticks last_slot(const model::Cluster& cluster);

}  // namespace ttf::schedules::left_out
