// The modes of a task in a cluster file (schedules/model/task_modes.h).
#pragma once

#include <vector>

#include "core/strict_yaml.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// Reads key `modes` of a task whose other keys are read; its activation is of kind `modes`. Each instant lies on the
// activation's grid and within its frame, behind the one before. It is for a camera of the task (camera_ports()), and
// takes a time between the task's best and worst case. Each frame looks at the whole picture of each camera. A frame of
// which that is not so is a finding.
std::vector<model::TaskMode> load_modes(YamlMap& map, const model::Task& task);

}  // namespace ttf::schedules::file
