// From a scan to vehicles: segmentation, then a rectangle per segment.
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
  int fewest_points = 3;           // fewer are no object, nor are those of a single beam
  double longest_extent_m = 12.0;  // longer segments are walls and hedges, not vehicles
};
LaserPreprocessingConfig load_laser_preprocessing(YamlMap& yaml);

class LaserPreprocessor {
 public:
  // `most_points`: of a scan. Room for them is taken here, and there are never more segments than points.
  LaserPreprocessor(const LaserPreprocessingConfig& config, std::size_t most_points);
  // Objects in order of azimuth, right to left; nothing allocates where `out` has room for most_objects().
  void process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out);
  std::size_t most_objects() const { return most_points_ / static_cast<std::size_t>(config_.fewest_points); }

 private:
  LaserPreprocessingConfig config_;
  std::size_t most_points_;
  std::vector<PlanePoint> points_;
  std::vector<Segment> segments_;
};

}  // namespace ttf::nodes::laser
