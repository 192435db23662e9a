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

// Counts the fates of a scan's segments: each is an object, or is left out for one reason.
struct SegmentFates {
  std::size_t objects = 0;
  std::size_t small = 0;        // fewer points than fewest_points
  std::size_t single_beam = 0;  // no usable extent
  std::size_t large = 0;        // longer than longest_extent_m
  std::size_t segments() const { return objects + small + single_beam + large; }
};

class LaserPreprocessor {
 public:
  // Reserves room for `most_points`, the points of the largest scan. A scan never has more segments than points.
  LaserPreprocessor(const LaserPreprocessingConfig& config, std::size_t most_points);
  // Fills `out` with the scan's objects by azimuth, right to left. Allocates only if `out` lacks room for
  // most_objects().
  void process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out);
  const SegmentFates& fates() const { return fates_; }  // for the last scan
  std::size_t most_objects() const { return most_points_ / static_cast<std::size_t>(config_.fewest_points); }

 private:
  LaserPreprocessingConfig config_;
  std::size_t most_points_;
  std::vector<PlanePoint> points_;
  std::vector<Segment> segments_;
  SegmentFates fates_;
};

}  // namespace ttf::nodes::laser
