// The stages of a measurement's path and the walk through them, for schedules/analysis/ages.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schedules/analysis/ages.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

struct Stage {
  enum class Kind : std::uint8_t { kSpan, kActivation, kSlots };
  std::string name;
  Kind kind = Kind::kSpan;
  Duration best{}, worst{};      // kSpan, drift included
  model::CycleInstant at{};      // kActivation
  std::vector<SlotGroup> slots;  // kSlots
  Duration shortest{};           // kSlots in the dynamic segment: from write to arrival, drift included
  // kActivation: the stage before is another task's execution on the same processor. An instant that comes while
  // it runs does not pass: first come, first served, and the task starts right behind it.
  bool behind_execution = false;

  // In the dynamic segment an early list is sent as soon as it is written, at any phase. The stage is then on
  // the cycle's grid for the latest instants only.
  bool on_grid(bool latest) const {
    return kind == Kind::kActivation || (kind == Kind::kSlots && (latest || !slots.front().dynamic));
  }
};

struct Path {
  SensorId sensor = kNoSensor;
  std::vector<Stage> stages;
  std::size_t available = 0;          // stages until the list is in the fusion node's CNI
  std::size_t fused = 0;              // until the fusing task starts
  std::size_t used = 0;               // until the image's reader starts; 0: no reader
  bool on_arrival = false;            // the fusing task is activated by this list
  bool chosen = false;                // a task that holds lists passes some measurements on, and not others
  bool held = true;                   // BUFF may hold the list: it is fused, and not read by a service itself
  model::CycleInstant use{0, 0, {}};  // the reader's; repetition 0 if time does not activate it
  std::vector<Waypoint> waypoints;    // without bounds
};

// Returns the path of a sensor's lists; without stages if they reach no fusing task. The cluster must have
// passed check().
Path path_of(const model::Cluster& cluster, SensorId sensor);

// One hop of a way from task to task: `task` of `node` reads the list `out`. The task before it writes the list. Or it
// fuses and writes nothing, and another task of its node writes the list, the image.
struct Reading {
  const model::PortBinding* out = nullptr;
  NodeId node{};
  const model::Task* task = nullptr;
};
// Returns the path from the sensor's measuring task along the readings, to the start of the last one's task; without
// stages if there is no bound. The cluster must have passed check().
Path path_along(const model::Cluster& cluster, SensorId sensor, const std::vector<Reading>& way);
// Returns the ages along such paths, to their ends.
std::vector<AgePath> ages_along(const model::Cluster& cluster, const std::vector<Path>& paths);

const model::Task* measuring_task(const model::Cluster& cluster, SensorId sensor);
// Returns whether the task reads a list of no single sensor, as a service does; a fusing one reads none.
bool reads_shared(const model::Cluster& cluster, const model::Task& task);
// Returns the task of a fusing node that writes the image, and the image's binding; null if there is none.
struct Publisher {
  const model::Task* task = nullptr;
  const model::PortBinding* image = nullptr;
};
Publisher publisher_of(const model::Cluster& cluster, NodeId node);

// Returns the latest or earliest instants after stages first..last-1 of the path, entered at `start`
// (nanoseconds of global time). They include the difference between clocks, except at an exact first stage on
// the grid.
std::vector<std::int64_t> walk(const model::Cluster& cluster, const Path& path, std::size_t first, std::size_t last,
                               std::int64_t start, bool latest, bool first_is_exact);

// Returns the last instants for entering a stage on the grid, within a round from `from_cycle` (earliest). For
// the latest walk they are one nanosecond later, so that the list may miss the stage.
std::vector<std::int64_t> entries(const model::Cluster& cluster, const Stage& stage, std::int64_t from_cycle,
                                  bool latest);

}  // namespace ttf::schedules::analysis
