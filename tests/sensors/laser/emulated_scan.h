// Scans of cars at chosen poses, from the emulated laser, in the form preprocessing takes.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/laser/model.h"
#include "sensors/laser/scan_point.h"

namespace ttf::sensors::laser {

inline constexpr std::size_t kMostPoints = 1300;  // four layers of 325 beams

inline sim::world::ObjectState car_at(double x, double y, double heading, double length = 4.4, double width = 1.8,
                                      std::uint16_t id = 0) {
  sim::world::ObjectState state;
  state.id = ObjectId{id};
  state.x = x;
  state.y = y;
  state.heading = heading;
  state.length = length;
  state.width = width;
  return state;
}

inline std::vector<ScanPoint> emulated_scan(const LaserConfig& config,
                                            const std::vector<sim::world::ObjectState>& objects,
                                            std::uint32_t sequence) {
  std::vector<HitPoint> hits;
  std::vector<ObjectId> truth;
  measure_laser(config, objects, {1, 0, 0, sequence}, hits, truth);
  std::vector<ScanPoint> scan;
  for (const HitPoint& hit : hits) scan.push_back({hit.layer, hit.azimuth, hit.range});
  return scan;
}

}  // namespace ttf::sensors::laser
