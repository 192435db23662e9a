// Regions of interest: rectangles of cameras' pictures, a list on the bus from a planner to an adaptive camera.
//
// An element has `sensor`, the camera's place among the cluster's sensors, from 0. The left edge `x` and the upper edge
// `y` count from the middle of the picture, rows downwards. They, `width` and `height` are in pixels. An element with
// `valid` 0 counts for nothing. The list's time stamp is the instant of its issue. A list replaces all before it. An
// empty one says that nothing is of interest.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::vision {

struct Region {
  SensorId sensor = kNoSensor;
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;  // [px]
  bool valid = false;

  bool holds(double column, double row) const {
    return x <= column && column <= x + width && y <= row && row <= y + height;
  }
  double area() const { return width * height; }
};

using RegionSignals = std::array<std::size_t, 6>;
RegionSignals bind_regions(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout);
// Replaces `regions` by those of the list that are valid. Allocates nothing if they have room for a whole list.
void decode_regions(const schedules::model::PduLayout& layout, const bus::cni::ListView& list,
                    const RegionSignals& signals, std::vector<Region>& regions);

// The output `regions` of a planner: it numbers its lists.
class RegionOutput {
 public:
  RegionOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
  // Issues a list of the first regions that have room in it.
  void issue(host::StepContext& context, std::span<const Region> regions);

 private:
  std::size_t port_ = 0;
  RegionSignals signals_;
  std::uint32_t sequence_ = 0;
};

}  // namespace ttf::nodes::vision
