// Cuts a scan into segments: the returns of one object each.
//
// Adaptive breakpoint detection (Borges and Aldon, "Line extraction in 2D range images for mobile robotics", Journal
// of Intelligent and Robotic Systems 40, 2004, eq. 4) separates neighbours in azimuth that are further apart than
//   D = r sin(dphi) / sin(lambda - dphi) + 3 sigma.
// D is the distance of two returns from a surface seen under the incidence angle lambda. The formula holds for
// neighbouring beams, with at most two missed beams between them. Across a wider gap only the smallest gap holds
// returns together. D has an upper bound: at very flat incidence, the next return may belong to another vehicle. All
// layers are taken together. A near object in front of the middle of a far one cuts the far one into two segments.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sensors/laser/scan_point.h"

namespace ttf::sensors::laser {

// A return in the plane [m].
struct PlanePoint {
  double x = 0.0, y = 0.0;
  double azimuth = 0.0, range = 0.0;
};

// The returns points[first .. first + count).
struct Segment {
  std::size_t first = 0;
  std::size_t count = 0;
};

struct SegmentationConfig {
  double range_noise_m = 0.06;
  double incidence_rad = 0.06;  // lambda, the flattest incidence that holds a surface together: 3.4 degrees
  double smallest_gap_m = 0.6;  // closer neighbours are never separated: cars have windows and wheels
  double largest_gap_m = 2.0;   // more distant ones are always separated
  double azimuth_step_rad = 0.00436;
};

// Returns how far apart [m] two returns, `step` [rad] apart in azimuth, may be and still be held together. The nearer one is
// at `range` [m].
double held_gap(const SegmentationConfig& config, double range, double step);

// Sorts the scan by azimuth into `points` and cuts it into `segments`. Both keep their capacity.
void segment_scan(const SegmentationConfig& config, std::span<const ScanPoint> scan, std::vector<PlanePoint>& points,
                  std::vector<Segment>& segments);

}  // namespace ttf::sensors::laser
