// Mends segmentation by outlines: joins the pieces of one vehicle, and splits what two vehicles make together.
//
// Join. Glass and dark paint return nothing, so that a side falls into pieces. Neighbouring segments are joined if
//   - beams between them returned nothing, and the gap is at most join_gap;
//   - one of them is shorter than any vehicle's end: two whole ends are two vehicles;
//   - both lie on one face, or about one corner, up to `straightest`;
//   - together they are no longer than a car.
//
// Split. Two vehicles nearer than the smallest gap are one segment. If no outline fits it well, it is cut at a step. The
// step is at least split_step deep. Both lines beside it are straighter by far than one line, and than any right angle.
//
// A join takes O(n) for both segments. A segment is joined with each neighbour once at most. A split takes O(n), and is
// repeated up to kMostSplits deep. So a scan of n returns takes O(n log n): it is sorted before.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {

struct PartsConfig {
  double join_gap_m = 1.2;        // 0: never
  double split_step_m = 0.3;      // 0: never
  double straightest_m = 0.15;    // root mean square that a real car's outline may leave
  double shortest_end_m = 1.3;    // of a vehicle
  double longest_joined_m = 6.5;  // cars
};

// So many splits of splits: a row of sixteen vehicles.
inline constexpr int kMostSplits = 4;

// Joins neighbouring segments in place.
void join_parts(const PartsConfig& parts, const SegmentationConfig& segmentation, std::span<const PlanePoint> points,
                std::vector<Segment>& segments);

// Returns how many of the segment's returns are before the step; nothing if there is none. Each part has at least `fewest`
// returns.
std::optional<std::size_t> step_in(const PartsConfig& parts, std::span<const PlanePoint> points, std::size_t fewest);

}  // namespace ttf::sensors::laser
