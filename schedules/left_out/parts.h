// The instants, periods and deadlines that a file leaves out. The model has placeholders in their place.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::left_out {

// The parts of a periodic instant that are left out.
struct Instant {
  bool instant = false;     // base cycle and offset, or base cycle and slot
  bool repetition = false;  // it follows from other repetitions (periods.h)
};

// A sensor that is like another one, without a device and a host of its own (schedules/file/likeness/sensor_copy.h).
struct Copied {
  SensorId sensor{}, from{};
};

struct TaskParts {
  Instant at;                                   // for a task that time activates
  bool deadline = false;                        // left out
  int line = 0;                                 // the activation's
  std::optional<Copied> copied = std::nullopt;  // for this sensor
};

// A list's static slots, all in one cycle and one behind the other.
struct List {
  PduId pdu{};
  NodeId sender{};
  model::Channels channels = model::Channels::kAB;
  int base_cycle = 0, repetition = 1, slot = 1;  // placeholders where they are left out
  Instant at;
  int line = 0;
  std::optional<int> entry = std::nullopt;  // in the file's list `frames`; none: of a copied sensor
  bool anywhere = false;                    // takes the first free slots: its sensor measures freely
  std::optional<Copied> copied = std::nullopt;
};

// Returns the list's place for findings: "frames[3]", or "frames (rear_objects)" for a list of a copied sensor.
std::string path_of(const model::Cluster& cluster, const List& list);

// All that a file leaves out.
struct Parts {
  std::vector<Instant> sensors;                     // by sensor
  std::vector<std::vector<TaskParts>> tasks;        // by node and task
  std::vector<List> lists;                          // those with a value left out; the model has no frames of them
  std::vector<std::vector<bool>> shortest_periods;  // by CAN and message
};

}  // namespace ttf::schedules::left_out
