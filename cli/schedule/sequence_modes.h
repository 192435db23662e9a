// `ttfusion schedule sequence --cluster`: sequences as time-triggered modes of a cluster's detector.
#pragma once

#include <string>
#include <vector>

#include "core/time.h"
#include "schedules/modes/detection_modes.h"
#include "schedules/sequence/detections.h"

namespace ttf::cli::schedule {

struct ModesAsked {
  std::string cluster, task;  // as typed: a file and NODE.TASK
  schedules::modes::Grid grid;
  schedules::sequence::DetectionTimes times;
  std::string sensors;
  std::vector<Duration> bounds;  // beta of each mode
  std::vector<schedules::sequence::Sequence> sequences;
  bool json = false, yaml = false;
};

// Prints the checked modes, and the bounds of the chains behind them; or the modes alone, as lines of a cluster file.
void print_modes(const ModesAsked& asked);

}  // namespace ttf::cli::schedule
