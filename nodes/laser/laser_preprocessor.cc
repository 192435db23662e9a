#include "nodes/laser/laser_preprocessor.h"

#include <algorithm>
#include <cmath>

#include "nodes/laser/orientation_search.h"

namespace ttf::nodes::laser {

LaserPreprocessingConfig load_laser_preprocessing(YamlMap& yaml) {
  LaserPreprocessingConfig c;
  const double noise = yaml.number_or("range_noise", c.rectangle.range_noise_m, {0.001, 2.0}, "m");
  const double step = yaml.number_or("azimuth_step", c.rectangle.azimuth_step_rad, {0.0001, 0.1}, "rad");
  c.segmentation.range_noise_m = c.rectangle.range_noise_m = noise;
  c.segmentation.azimuth_step_rad = c.rectangle.azimuth_step_rad = step;
  c.segmentation.smallest_gap_m = yaml.number_or("smallest_gap", c.segmentation.smallest_gap_m, {0.05, 5.0}, "m");
  c.segmentation.incidence_rad = yaml.number_or("incidence", c.segmentation.incidence_rad, {0.02, 1.0}, "rad");
  c.segmentation.largest_gap_m =
      yaml.number_or("largest_gap", c.segmentation.largest_gap_m, {c.segmentation.smallest_gap_m, 10.0}, "m");
  c.rectangle.nominal_length_m = yaml.number_or("nominal_length", c.rectangle.nominal_length_m, {1.0, 20.0}, "m");
  c.rectangle.length_sigma_m = yaml.number_or("length_sigma", c.rectangle.length_sigma_m, {0.01, 5.0}, "m");
  c.rectangle.nominal_width_m = yaml.number_or("nominal_width", c.rectangle.nominal_width_m, {0.5, 5.0}, "m");
  c.rectangle.width_sigma_m = yaml.number_or("width_sigma", c.rectangle.width_sigma_m, {0.01, 2.0}, "m");
  c.fewest_points = static_cast<int>(yaml.integer_or("fewest_points", c.fewest_points, {1, 100}));
  c.longest_extent_m = yaml.number_or("longest_extent", c.longest_extent_m, {1.0, 100.0}, "m");
  return c;
}

LaserPreprocessor::LaserPreprocessor(const LaserPreprocessingConfig& config, std::size_t most_points)
    : config_(config), most_points_(most_points) {
  points_.reserve(most_points);
  segments_.reserve(most_points);
  prepare_orientation_search();  // outside the first scan's deadline
}

void LaserPreprocessor::process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out) {
  out.clear();
  fates_ = {};
  segment_scan(config_.segmentation, scan, points_, segments_);
  for (const Segment& segment : segments_) {
    if (segment.count < static_cast<std::size_t>(config_.fewest_points)) {
      ++fates_.small;
      continue;
    }
    const std::span<const PlanePoint> points(points_.data() + segment.first, segment.count);
    // A single beam with all its layers is a post, or a side seen too flatly: it has no usable extent.
    if (points.back().azimuth - points.front().azimuth < 0.5 * config_.segmentation.azimuth_step_rad) {
      ++fates_.single_beam;
      continue;
    }
    double low_x = points[0].x, high_x = low_x, low_y = points[0].y, high_y = low_y;
    for (const PlanePoint& point : points) {
      low_x = std::min(low_x, point.x);
      high_x = std::max(high_x, point.x);
      low_y = std::min(low_y, point.y);
      high_y = std::max(high_y, point.y);
    }
    if (std::hypot(high_x - low_x, high_y - low_y) > config_.longest_extent_m) {
      ++fates_.large;
      continue;
    }
    out.push_back(fit_rectangle(config_.rectangle, points));
    ++fates_.objects;
  }
}

}  // namespace ttf::nodes::laser
