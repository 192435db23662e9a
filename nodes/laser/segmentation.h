// Which returns of a scan belong to one object.
//
// Adaptive breakpoint detection (Borges and Aldon, "Line extraction in 2D range images for mobile robotics", Journal of
// Intelligent and Robotic Systems 40, 2004, eq. 4): neighbours in azimuth are separated where they are further apart
// than
//   D = r sin(dphi) / sin(lambda - dphi) + 3 sigma,
// the distance two returns of a surface seen under the incidence angle lambda would have. That holds for beams next to
// each other, with a missed one or two between them; across a wider gap without returns there is no surface to speak
// of, and only the smallest gap holds. D is bounded too: seen that flatly, the next return may as well be another
// vehicle's. The layers are taken together. A near object that covers the middle of a far one leaves the far one as two
// segments.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "nodes/laser/scan_point.h"

namespace ttf::nodes::laser {

// A return in the plane [m].
struct PlanePoint {
  double x = 0.0, y = 0.0;
  double azimuth = 0.0, range = 0.0;
};

// points[first .. first + count)
struct Segment {
  std::size_t first = 0;
  std::size_t count = 0;
};

struct SegmentationConfig {
  double range_noise_m = 0.06;
  double incidence_rad = 0.06;  // lambda, the flattest incidence that still holds together: 3.4 degrees
  double smallest_gap_m = 0.6;  // never separate closer neighbours: cars have windows and wheels
  double largest_gap_m = 2.0;   // always separate more distant ones
  double azimuth_step_rad = 0.00436;
};

// Sorts the scan by azimuth into `points` and cuts it into `segments`. Both keep their capacity.
void segment_scan(const SegmentationConfig& config, std::span<const ScanPoint> scan, std::vector<PlanePoint>& points,
                  std::vector<Segment>& segments);

}  // namespace ttf::nodes::laser
