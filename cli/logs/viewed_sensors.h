// The sensors of a drive's scene: names and colours from its log, places and fields from the descriptions attached to it.
#pragma once

#include <string>
#include <vector>

#include "recording/merge/merge.h"
#include "recording/scene/viewed.h"

namespace ttf::cli::logs {

// Returns the sensors by SensorId. Places and fields are absent where the log has none; a warning names descriptions that
// cannot be read.
std::vector<recording::scene::ViewedSensor> viewed_sensors(const recording::merge::MergedLogs& drive,
                                                           std::vector<std::string>& warnings);

}  // namespace ttf::cli::logs
