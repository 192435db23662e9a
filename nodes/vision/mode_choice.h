// The choice of a detector's next mode, by the cameras that have a region of interest now.
//
//   1. The scenario's rows come first: the first row that names exactly these cameras says the mode.
//   2. Without such a row it is the mode whose secondary detections fit these cameras best: it has the fewest cameras with
//      secondary detections and without a region. Among those, it leaves the fewest cameras with a region without one. Among
//      those, it is the first in the cluster's file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "nodes/vision/config.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::vision {

// Cameras by their places among the task's: bit i is camera i.
using CameraSet = std::uint32_t;

class ModeChoice {
 public:
  // The rows' cameras and modes are those of the task (sim/drives/detectors.h).
  ModeChoice(const schedules::model::Task& task, const std::vector<ModeOfRegions>& rows);
  // Returns the place of the mode among the task's.
  std::size_t of(CameraSet with_region) const;

 private:
  struct Row {
    CameraSet cameras = 0;
    std::size_t mode = 0;
  };
  std::vector<Row> rows_;
  std::vector<CameraSet> secondaries_;  // by mode
};

}  // namespace ttf::nodes::vision
