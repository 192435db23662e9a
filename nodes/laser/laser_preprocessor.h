// Turns a scan into vehicles: segments it, then fits a rectangle to each segment.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "nodes/laser/rectangle_fit.h"
#include "nodes/laser/segmentation.h"

namespace ttf::nodes::laser {

struct LaserPreprocessingConfig {
  SegmentationConfig segmentation;
  RectangleConfig rectangle;
  int fewest_points = 3;           // smaller segments are no objects, nor are segments of a single beam
  double longest_extent_m = 12.0;  // longer segments are walls and hedges, not vehicles
};
LaserPreprocessingConfig load_laser_preprocessing(YamlMap& yaml);

class LaserPreprocessor {
 public:
  // Reserves room for `most_points`, the points of the largest scan. A scan never has more segments than points.
  LaserPreprocessor(const LaserPreprocessingConfig& config, std::size_t most_points);
  // Fills `out` with the scan's objects by azimuth, right to left. Allocates only if `out` lacks room for
  // most_objects().
  void process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out);
  std::size_t most_objects() const { return most_points_ / static_cast<std::size_t>(config_.fewest_points); }

 private:
  LaserPreprocessingConfig config_;
  std::size_t most_points_;
  std::vector<PlanePoint> points_;
  std::vector<Segment> segments_;
};

}  // namespace ttf::nodes::laser
