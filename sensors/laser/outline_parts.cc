#include "sensors/laser/outline_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sensors/laser/outline_fit.h"
#include "sensors/laser/scatter.h"

namespace ttf::sensors::laser {
namespace {

// A whole beam is missing between two returns that are further apart than this many steps.
constexpr double kMissing = 1.5;
// Beams of each line: two make a line of any two objects.
constexpr std::size_t kBeamsOfLine = 3;
// Two lines count if their squares are below this share of those of one line.
constexpr double kFarStraighter = 0.25;

double length_of(std::span<const PlanePoint> points) {
  return std::hypot(points.back().x - points.front().x, points.back().y - points.front().y);
}

// Whether one outline fits all returns.
bool one_outline(std::span<const PlanePoint> points, double step, double noise, double straightest) {
  const auto n = static_cast<double>(points.size());
  const double most = std::max(straightest, 2.0 * noise);
  const std::optional<FaceFit> face = fit_face(points, noise);
  if (face && face->squares <= most * most * n) return true;
  if (points.size() < 4) return false;
  const std::optional<CornerFit> corner = fit_corner(points, noise, step, face);
  return corner && corner->squares <= most * most * n;
}

double least_scatter(const Moments& moments) {
  Scatter scatter;
  scatter.add(moments, false);
  return std::max(0.0, scatter.least());
}

double least_angle(const Moments& right, const Moments& left) {
  Scatter scatter;
  scatter.add(right, false);
  scatter.add(left, true);
  return std::max(0.0, scatter.least());
}

}  // namespace

void join_parts(const PartsConfig& parts, const SegmentationConfig& segmentation, std::span<const PlanePoint> points,
                std::vector<Segment>& segments) {
  if (parts.join_gap_m <= 0.0 || segments.empty()) return;
  std::size_t last = 0;  // segment that is kept
  for (std::size_t s = 1; s < segments.size(); ++s) {
    const Segment& before = segments[last];
    const Segment& after = segments[s];
    const PlanePoint& end = points[before.first + before.count - 1];
    const PlanePoint& begin = points[after.first];
    const Segment both{before.first, before.count + after.count};
    const std::span<const PlanePoint> all = points.subspan(both.first, both.count);
    const double shorter = std::min(length_of(all.first(before.count)), length_of(all.last(after.count)));
    const bool candidates = std::hypot(begin.x - end.x, begin.y - end.y) <= parts.join_gap_m &&
                            begin.azimuth - end.azimuth > kMissing * segmentation.azimuth_step_rad &&
                            shorter < parts.shortest_end_m && length_of(all) <= parts.longest_joined_m &&
                            before.count >= 2 && after.count >= 2;
    if (candidates && one_outline(all, segmentation.azimuth_step_rad, segmentation.range_noise_m, parts.straightest_m))
      segments[last] = both;
    else
      segments[++last] = after;
  }
  segments.resize(last + 1);
}

std::optional<std::size_t> step_in(const PartsConfig& parts, std::span<const PlanePoint> points, std::size_t fewest) {
  if (parts.split_step_m <= 0.0 || points.size() < 2 * fewest) return std::nullopt;
  std::size_t beams = 1, beams_before = 1;
  for (std::size_t i = 1; i < points.size(); ++i) beams += points[i].azimuth != points[i - 1].azimuth;
  const PlanePoint& origin = points.front();
  Moments all, before;
  for (const PlanePoint& point : points) all.add(point.x - origin.x, point.y - origin.y);
  // The squares of two separate lines, at a step; and of one outline: a line, or a right angle anywhere.
  double least = std::numeric_limits<double>::infinity(), one = least_scatter(all);
  std::size_t best = 0;
  for (std::size_t i = 1; i + fewest <= points.size(); ++i) {
    before.add(points[i - 1].x - origin.x, points[i - 1].y - origin.y);
    if (points[i].azimuth == points[i - 1].azimuth) continue;
    one = std::min(one, least_angle(before, all - before));
    const std::size_t so_far = beams_before++;
    if (i < fewest || so_far < kBeamsOfLine || beams - so_far < kBeamsOfLine) continue;
    if (std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y) < parts.split_step_m ||
        std::abs(points[i].range - points[i - 1].range) < parts.split_step_m)
      continue;
    const double squares = least_scatter(before) + least_scatter(all - before);
    if (squares < least) {
      least = squares;
      best = i;
    }
  }
  if (best == 0) return std::nullopt;
  const auto n = static_cast<double>(points.size());
  if (least > kFarStraighter * one || least > parts.straightest_m * parts.straightest_m * n) return std::nullopt;
  return best;
}

}  // namespace ttf::sensors::laser
