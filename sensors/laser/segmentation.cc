#include "sensors/laser/segmentation.h"

#include <algorithm>
#include <cmath>

namespace ttf::sensors::laser {
namespace {

// Neighbours are at most three beams apart (two missed between them); half a beam more allows for rounded azimuths.
constexpr double kMissedBeams = 3.5;

}  // namespace

double held_gap(const SegmentationConfig& config, double range, double step) {
  if (step >= kMissedBeams * config.azimuth_step_rad) return config.smallest_gap_m;
  const double surface = step < config.incidence_rad ? range * std::sin(step) / std::sin(config.incidence_rad - step)
                                                     : config.largest_gap_m;
  return std::clamp(surface + 3.0 * config.range_noise_m, config.smallest_gap_m, config.largest_gap_m);
}

void segment_scan(const SegmentationConfig& config, std::span<const ScanPoint> scan, std::vector<PlanePoint>& points,
                  std::vector<Segment>& segments) {
  points.clear();
  segments.clear();
  // A beam's returns from all layers follow each other and share one direction.
  double azimuth = 0.0, c = 1.0, s = 0.0;
  for (const ScanPoint& point : scan) {
    if (point.azimuth != azimuth) {
      azimuth = point.azimuth;
      c = std::cos(azimuth);
      s = std::sin(azimuth);
    }
    points.push_back({point.range * c, point.range * s, point.azimuth, point.range});
  }
  std::sort(points.begin(), points.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.azimuth != b.azimuth ? a.azimuth < b.azimuth : a.range < b.range;
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool same = !segments.empty();
    if (same) {
      const PlanePoint& previous = points[i - 1];
      const double step = std::max(config.azimuth_step_rad, points[i].azimuth - previous.azimuth);
      same = std::hypot(points[i].x - previous.x, points[i].y - previous.y) <=
             held_gap(config, std::min(previous.range, points[i].range), step);
    }
    if (same)
      ++segments.back().count;
    else
      segments.push_back({i, 1});
  }
}

}  // namespace ttf::sensors::laser
