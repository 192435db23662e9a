// Turns a scan into vehicles: segments it, joins and splits segments, fits a rectangle to each, and leaves out what no
// vehicle fits. The latter stands: poles, walls and bushes are handed on as outlines.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"
#include "sensors/laser/outline_parts.h"
#include "sensors/laser/rectangle_fit.h"
#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {

// Separates segments that a vehicle fits from those that none fits (VehicleShape). A pole is thin only if both of its ends
// are seen: a car that is almost hidden is no pole.
struct ShapeConfig {
  double thinnest_m = 0.5;   // 0: nothing is too thin
  double roughest_m = 0.25;  // root mean square of the range errors that the best outline leaves
};

struct LaserPreprocessingConfig {
  SegmentationConfig segmentation;
  RectangleConfig rectangle;
  PartsConfig parts;
  ShapeConfig shape;
  double half_field_rad = 1.05;    // the scan reaches so far; an outline that it cuts has no end there
  int fewest_points = 3;           // smaller segments are no objects, nor are segments of a single beam
  double longest_extent_m = 12.0;  // longer segments are walls and hedges, not vehicles
  // A silhouette of which something nearer, or the field's edge, hides a part is reported: its middle errs by up to half of that part.
  bool cut_silhouettes = true;
  bool free_ends = true;  // an outline that the field's edge cuts is reported by its free end, if that is known
};
LaserPreprocessingConfig load_laser_preprocessing(YamlMap& yaml);

// Counts the fates of a scan's segments: each is an object, or is left out for one reason.
struct SegmentFates {
  std::size_t objects = 0;
  std::size_t small = 0;        // fewer points than fewest_points
  std::size_t single_beam = 0;  // no usable extent
  std::size_t large = 0;        // longer than longest_extent_m
  std::size_t thin = 0;         // thinner than a vehicle
  std::size_t rough = 0;        // no outline fits
  std::size_t cut = 0;          // silhouettes with a hidden end, or free ends, where these are left out
  std::size_t segments() const;
  SegmentFates& operator+=(const SegmentFates& other);
};

// The reasons for which a segment is left out, as outputs name them.
struct NamedFate {
  std::string_view name, words;
  std::size_t SegmentFates::*count;
};
inline constexpr std::array<NamedFate, 6> kOtherFates{{{"small", "too few returns", &SegmentFates::small},
                                                       {"single_beam", "single beams", &SegmentFates::single_beam},
                                                       {"large", "too long", &SegmentFates::large},
                                                       {"thin", "too thin", &SegmentFates::thin},
                                                       {"rough", "too rough", &SegmentFates::rough},
                                                       {"cut", "cut", &SegmentFates::cut}}};

class LaserPreprocessor {
 public:
  // Reserves room for `most_points`, the points of the largest scan. A scan never has more segments than points.
  LaserPreprocessor(const LaserPreprocessingConfig& config, std::size_t most_points);
  // Fills `out` with the scan's objects by azimuth, right to left. Allocates only if `out` lacks room for
  // most_objects(). Without `is_whole` the list had no room for all returns, and an object at the last one is cut.
  void process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out, bool is_whole = true);
  const SegmentFates& fates() const { return fates_; }  // for the last scan
  // The segments of the last scan that no vehicle fits, by azimuth: too long, too thin or too rough. They are spans of
  // its returns, which are valid until the next scan.
  const std::vector<std::span<const PlanePoint>>& outlines() const { return outlines_; }
  std::size_t most_objects() const { return most_points_ / static_cast<std::size_t>(config_.fewest_points); }

 private:
  OutlineEnds ends_of(const Segment& segment) const;
  void take(const Segment& segment, int splits, std::vector<LaserObject>& out);

  LaserPreprocessingConfig config_;
  std::size_t most_points_;
  bool is_whole_ = true;
  std::vector<PlanePoint> points_;
  std::vector<Segment> segments_;
  std::vector<std::span<const PlanePoint>> outlines_;
  SegmentFates fates_;
};

}  // namespace ttf::sensors::laser
