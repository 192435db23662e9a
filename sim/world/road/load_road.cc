#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/world/road/road.h"

namespace ttf::sim::world::road {
namespace {

constexpr Range<double> kCurvature{-0.5, 0.5};  // [1/m]
constexpr double kLongest_m = 20'000.0;
constexpr double kMostTurn_rad = 50.0;  // of a piece
// A closed road's end and beginning may differ by the rounding of a file's numbers.
constexpr double kJoint_m = 0.01, kJoint_rad = 0.001;

Piece load_piece(YamlMap& yaml) {
  Piece piece;
  piece.length = yaml.number("length", {0.1, kLongest_m}, "m");
  piece.curvature = yaml.number_or("curvature", 0.0, kCurvature, "1/m");
  if (yaml.has("end_curvature"))
    piece.change = (yaml.number("end_curvature", kCurvature, "1/m") - piece.curvature) / piece.length;
  const double sharpest = std::max(std::abs(piece.curvature), std::abs(piece.curvature + piece.change * piece.length));
  if (piece.length * sharpest > kMostTurn_rad) {
    yaml.fail("length", fmt::format("must be at most {:.6g} m at this curvature: a piece turns {} rad at most",
                                    kMostTurn_rad / sharpest, kMostTurn_rad));
    piece.curvature = piece.change = 0.0;  // an endless spiral would keep the reader busy
  }
  yaml.finish();
  return piece;
}

std::string lanes_of(const RoadConfig& road) {
  const std::string right = road.right == 1 ? "-1" : fmt::format("{}..-1", -road.right),
                    left = road.left == 1 ? "1" : fmt::format("1..{}", road.left);
  return road.left == 0 ? right : road.right == 0 ? left : right + " or " + left;
}

}  // namespace

RoadConfig load_road(YamlMap& yaml) {
  RoadConfig c;
  if (auto start = yaml.map_if("start")) {
    c.x = start->number_or("x", 0.0, {-10'000.0, 10'000.0}, "m");
    c.y = start->number_or("y", 0.0, {-10'000.0, 10'000.0}, "m");
    c.heading = start->number_or("heading", 0.0, {-7.0, 7.0}, "rad");
    start->finish();
  }
  if (auto lanes = yaml.map_if("lanes")) {
    c.left = static_cast<int>(lanes->integer_or("left", c.left, {0, 8}));
    c.right = static_cast<int>(lanes->integer_or("right", c.right, {0, 8}));
    c.lane_width = lanes->number_or("width", c.lane_width, {1.0, 10.0}, "m");
    if (c.left + c.right == 0) lanes->fail("right", "must be at least 1 where there is no lane on the left");
    lanes->finish();
  }
  double length = 0.0;
  for (YamlMap& piece : yaml.maps("pieces")) {
    c.pieces.push_back(load_piece(piece));
    length += c.pieces.back().length;
  }
  if (c.pieces.empty() || length > kLongest_m) {
    yaml.fail("pieces", fmt::format("must have one piece or more, and {} m at most", kLongest_m));
    c.pieces = {Piece{1.0}};
  }
  c.closed = yaml.boolean_or("closed", false);
  if (c.closed) {
    const Pose end = end_of(c);
    const double apart = std::hypot(end.x - c.x, end.y - c.y),
                 turned = std::remainder(end.heading - c.heading, 2.0 * std::numbers::pi);
    if (apart > kJoint_m || std::abs(turned) > kJoint_rad)
      yaml.fail("closed", fmt::format("must be false, since the road ends {:.3f} m and {:.4f} rad from its beginning",
                                      apart, std::abs(turned)));
  }
  yaml.finish();
  return c;
}

int load_lane(YamlMap& yaml, std::string_view key, const RoadConfig& road) {
  constexpr std::int64_t kMostLanes = 8;
  const auto lane = static_cast<int>(yaml.integer(key, {-kMostLanes, kMostLanes}));
  if (lane != 0 && lane <= road.left && lane >= -road.right) return lane;
  yaml.fail(key, "must be a lane of the road: " + lanes_of(road));
  return road.right > 0 ? -1 : 1;
}

OnLane load_on_lane(YamlMap& yaml, const RoadConfig& road) {
  OnLane on;
  on.lane = load_lane(yaml, "lane", road);
  on.station = yaml.number("s", {-1000.0, kLongest_m}, "m");
  yaml.finish();
  return on;
}

}  // namespace ttf::sim::world::road
