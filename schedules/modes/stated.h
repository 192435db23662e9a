// The modes that a cluster's file states (schedules/model/task_modes.h), as those of schedules/modes/detection_modes.h, and as
// lines of a file.
#pragma once

#include <string>
#include <vector>

#include "schedules/model/cluster.h"
#include "schedules/modes/detection_modes.h"

namespace ttf::schedules::modes {

struct StatedModes {
  Detector detector;
  Grid grid;
  std::vector<Mode> modes;
};
// Returns the modes of each task that has some, in the order of the file. They point into the cluster.
std::vector<StatedModes> stated_modes(const model::Cluster& cluster);

// Returns the letters A, B, ... of so many cameras.
std::string camera_letters(std::size_t cameras);

// Returns the keys of a task's mapping that state such modes: its activation, its times and `modes`, indented as they stand in
// a cluster file. Modes of equal name are there once. The task reads and writes a list of each camera of the modes.
std::string yaml_text(const model::Cluster& cluster, const Detector& detector, const std::vector<Mode>& modes,
                      const Grid& grid);

}  // namespace ttf::schedules::modes
