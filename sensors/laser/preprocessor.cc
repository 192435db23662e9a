#include "sensors/laser/preprocessor.h"

#include <algorithm>
#include <cmath>

namespace ttf::sensors::laser {
namespace {

using ttf::fusion::sensors::SeenPoint;

// An outline is rough only if so many returns say so. Noise must not make it so, in standard deviations.
constexpr std::size_t kFewestOfRough = 6;
constexpr double kNoiseOfRough = 3.0;
// A neighbour, or the field's edge, hides an end if it is within so many beams.
constexpr double kNextBeam = 2.5;
// One outline with no more than this left is not split, nor one with so many standard deviations of the noise.
constexpr double kSmooth_m = 0.08, kNoiseOfSmooth = 1.5;

// `object` is the fit of `points`, those of one segment with these ends. `noise` [m] is that of a range. `step` [rad] is that of
// the beams.
VehicleShape shape_of(const ShapeConfig& config, const LaserObject& object, std::span<const PlanePoint> points,
                      const OutlineEnds& ends, double noise, double step) {
  if (points.size() >= kFewestOfRough && object.residual_m > std::max(config.roughest_m, kNoiseOfRough * noise))
    return VehicleShape::kRough;
  if (object.seen != SeenPoint::kSilhouette && !is_outermost(object.seen)) return VehicleShape::kVehicle;
  const PlanePoint &first = points.front(), &last = points.back();
  // The outline ends up to one step beyond its last beams. On the average it is half of that.
  const double across = std::hypot(last.x - first.x, last.y - first.y) + step * 0.5 * (first.range + last.range);
  if (!ends[0].hidden && !ends[1].hidden && across < config.thinnest_m) return VehicleShape::kThin;
  return VehicleShape::kPart;
}

}  // namespace

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
  for (const char* key : {"nominal_length", "length_sigma", "nominal_width", "width_sigma"})
    yaml.gone(key, "preprocessing says what it sees, and the tracker knows how long and wide objects are");
  c.half_field_rad = yaml.number_or("half_field", c.half_field_rad, {0.01, 3.15}, "rad");
  c.fewest_points = static_cast<int>(yaml.integer_or("fewest_points", c.fewest_points, {1, 100}));
  c.longest_extent_m = yaml.number_or("longest_extent", c.longest_extent_m, {1.0, 100.0}, "m");
  c.parts.join_gap_m = yaml.number_or("join_gap", c.parts.join_gap_m, {0.0, 5.0}, "m");
  c.parts.split_step_m = yaml.number_or("split_step", c.parts.split_step_m, {0.0, 5.0}, "m");
  c.shape.thinnest_m = yaml.number_or("thinnest", c.shape.thinnest_m, {0.0, 2.0}, "m");
  c.shape.roughest_m = yaml.number_or("roughest", c.shape.roughest_m, {0.01, 100.0}, "m");
  c.cut_silhouettes = yaml.boolean_or("cut_silhouettes", c.cut_silhouettes);
  c.free_ends = yaml.boolean_or("free_ends", c.free_ends);
  return c;
}

std::size_t SegmentFates::segments() const {
  std::size_t sum = objects;
  for (const NamedFate& fate : kOtherFates) sum += this->*fate.count;
  return sum;
}

SegmentFates& SegmentFates::operator+=(const SegmentFates& other) {
  objects += other.objects;
  for (const NamedFate& fate : kOtherFates) this->*fate.count += other.*fate.count;
  return *this;
}

LaserPreprocessor::LaserPreprocessor(const LaserPreprocessingConfig& config, std::size_t most_points)
    : config_(config), most_points_(most_points) {
  points_.reserve(most_points);
  segments_.reserve(most_points);
  outlines_.reserve(most_points);
}

void LaserPreprocessor::process(std::span<const ScanPoint> scan, std::vector<LaserObject>& out, bool is_whole) {
  is_whole_ = is_whole;
  out.clear();
  outlines_.clear();
  fates_ = {};
  segment_scan(config_.segmentation, scan, points_, segments_);
  join_parts(config_.parts, config_.segmentation, points_, segments_);
  for (const Segment& segment : segments_) take(segment, 0, out);
}

// Takes a segment as one object, or as several if it has been split less than kMostSplits times.
void LaserPreprocessor::take(const Segment& segment, int splits, std::vector<LaserObject>& out) {
  if (segment.count < static_cast<std::size_t>(config_.fewest_points)) {
    ++fates_.small;
    return;
  }
  const std::span<const PlanePoint> points(points_.data() + segment.first, segment.count);
  // A single beam with all its layers is a post, or a side seen too flatly: it has no usable extent.
  if (points.back().azimuth - points.front().azimuth < 0.5 * config_.segmentation.azimuth_step_rad) {
    ++fates_.single_beam;
    return;
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
    outlines_.push_back(points);
    return;
  }
  const double noise = config_.rectangle.range_noise_m, step = config_.segmentation.azimuth_step_rad;
  const OutlineEnds ends = ends_of(segment);
  const LaserObject object = fit_rectangle(config_.rectangle, points, ends);
  if (splits < kMostSplits && object.residual_m > std::max(kSmooth_m, kNoiseOfSmooth * noise))
    if (const auto before = step_in(config_.parts, points, static_cast<std::size_t>(config_.fewest_points))) {
      take({segment.first, *before}, splits + 1, out);
      take({segment.first + *before, segment.count - *before}, splits + 1, out);
      return;
    }
  const VehicleShape shape = shape_of(config_.shape, object, points, ends, noise, step);
  if (shape == VehicleShape::kThin || shape == VehicleShape::kRough) {
    ++(shape == VehicleShape::kThin ? fates_.thin : fates_.rough);
    outlines_.push_back(points);
    return;
  }
  const bool is_cut = object.seen == SeenPoint::kSilhouette && (ends[0].hidden || ends[1].hidden);
  if ((is_cut && !config_.cut_silhouettes) || (is_outermost(object.seen) && !config_.free_ends)) {
    ++fates_.cut;
    return;
  }
  out.push_back(object);
  out.back().shape = shape;
  ++fates_.objects;
}

OutlineEnds LaserPreprocessor::ends_of(const Segment& segment) const {
  const SegmentationConfig& config = config_.segmentation;
  OutlineEnds ends;
  const std::size_t last = segment.first + segment.count - 1;
  const auto describe = [&](OutlineEnd& end, const PlanePoint& own, std::size_t neighbour) {
    end.held_gap_m = held_gap(config, own.range, config.azimuth_step_rad);
    end.by_field = std::abs(std::abs(own.azimuth) - config_.half_field_rad) < kNextBeam * config.azimuth_step_rad ||
                   (neighbour == points_.size() && !is_whole_);
    end.hidden = end.by_field;
    if (end.hidden || neighbour >= points_.size()) return;
    const PlanePoint& other = points_[neighbour];
    end.hidden = std::abs(other.azimuth - own.azimuth) < kNextBeam * config.azimuth_step_rad && other.range < own.range;
  };
  describe(ends[0], points_[segment.first], segment.first - 1);  // 0 - 1: beyond all points
  describe(ends[1], points_[last], last + 1);
  return ends;
}

}  // namespace ttf::sensors::laser
