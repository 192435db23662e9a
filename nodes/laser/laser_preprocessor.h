// From a scan to vehicles: segmentation, then a rectangle per segment.
#pragma once

#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "nodes/laser/rectangle_fit.h"
#include "nodes/laser/segmentation.h"

namespace ttf::nodes {

struct LaserPreprocessingConfig {
  SegmentationConfig segmentation;
  RectangleConfig rectangle;
  int fewest_points = 3;             // fewer are no object, nor are those of a single beam
  double longest_extent_m = 12.0;    // longer segments are walls and hedges, not vehicles
};
LaserPreprocessingConfig load_laser_preprocessing(YamlMap& yaml);

class LaserPreprocessor {
 public:
  explicit LaserPreprocessor(const LaserPreprocessingConfig& config);
  // Objects in order of azimuth, right to left. Buffers are reused: no allocation after the first scans.
  void process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out);

 private:
  LaserPreprocessingConfig config_;
  std::vector<PlanePoint> points_;
  std::vector<Segment> segments_;
};

}  // namespace ttf::nodes
