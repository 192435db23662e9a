#include "sim/world/road/road.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace ttf::sim::world::road {
namespace {

constexpr double kLargestTurn_rad = 0.5;  // a part that one rule integrates
constexpr double kSpacing_m = 2.0;        // of samples
constexpr int kRefinements = 8;           // in a projection: each squares the error

// Abscissae and weights of Gauss and Legendre's rule of eight points on -1..1 (Abramowitz, Stegun, table 25.4).
constexpr std::array<double, 4> kAbscissae{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                           0.9602898564975363};
constexpr std::array<double, 4> kWeights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                         0.1012285362903763};

Pose straight_on(const Pose& from, double way) {
  return {from.x + way * std::cos(from.heading), from.y + way * std::sin(from.heading), from.heading};
}

// Integrates the direction of a clothoid over s..s + way.
Pose along_clothoid(const Piece& piece, const Pose& from, double way) {
  const double turn = std::max(std::abs(piece.curvature), std::abs(piece.curvature + piece.change * way)) * way;
  const int parts = 1 + static_cast<int>(turn / kLargestTurn_rad);
  const double half = 0.5 * way / parts;
  const auto heading = [&](double s) { return from.heading + s * (piece.curvature + 0.5 * piece.change * s); };
  Pose to{from.x, from.y, heading(way)};
  for (int part = 0; part < parts; ++part) {
    const double middle = (2 * part + 1) * half;
    for (std::size_t k = 0; k < kWeights.size(); ++k)
      for (const double side : {-1.0, 1.0}) {
        const double h = heading(middle + side * half * kAbscissae[k]);
        to.x += half * kWeights[k] * std::cos(h);
        to.y += half * kWeights[k] * std::sin(h);
      }
  }
  return to;
}

Pose along(const Piece& piece, const Pose& from, double way) {
  if (piece.change != 0.0) return along_clothoid(piece, from, way);
  const double turn = piece.curvature * way;
  if (std::abs(turn) < 1e-6) {
    // The chord, turned by half of the arc's turn.
    Pose to = straight_on({from.x, from.y, from.heading + 0.5 * turn}, way * (1.0 - turn * turn / 24.0));
    to.heading = from.heading + turn;
    return to;
  }
  const double chord = 2.0 * std::sin(0.5 * turn) / piece.curvature;
  Pose to = straight_on({from.x, from.y, from.heading + 0.5 * turn}, chord);
  to.heading = from.heading + turn;
  return to;
}

}  // namespace

Pose end_of(const RoadConfig& road) {
  Pose end{road.x, road.y, road.heading};
  for (const Piece& piece : road.pieces) end = along(piece, end, piece.length);
  return end;
}

Road::Road(const RoadConfig& config) : config_(config), end_{config.x, config.y, config.heading} {
  for (const Piece& piece : config_.pieces) {
    beginnings_.push_back({length_, end_});
    end_ = along(piece, end_, piece.length);
    length_ += piece.length;
  }
  TTF_CHECK(length_ > 0.0, "a road of {} m", length_);
  const auto parts = static_cast<std::size_t>(std::ceil(length_ / kSpacing_m));
  spacing_ = length_ / static_cast<double>(parts);
  for (std::size_t k = 0; k <= parts; ++k) samples_.push_back(line_at(static_cast<double>(k) * spacing_).pose);
}

LinePoint Road::line_at(double station) const {
  if (config_.closed) station -= length_ * std::floor(station / length_);
  if (station < 0.0) return {straight_on(beginnings_.front().pose, station)};
  if (station > length_) return {straight_on(end_, station - length_)};
  const auto next = std::upper_bound(beginnings_.begin(), beginnings_.end(), station,
                                     [](double s, const Beginning& beginning) { return s < beginning.station; });
  const auto piece = static_cast<std::size_t>(next - beginnings_.begin() - 1);  // the first one begins at 0
  const Piece& is = config_.pieces[piece];
  const double way = station - beginnings_[piece].station;
  return {along(is, beginnings_[piece].pose, way), is.curvature + is.change * way, is.change};
}

Pose Road::pose_at(const LinePlace& place) const {
  Pose pose = line_at(place.station).pose;
  pose.x -= place.offset * std::sin(pose.heading);
  pose.y += place.offset * std::cos(pose.heading);
  return pose;
}

LinePlace Road::place_of(double x, double y) const {
  const auto squared = [&](const Pose& pose) { return (pose.x - x) * (pose.x - x) + (pose.y - y) * (pose.y - y); };
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < samples_.size(); ++k)
    if (squared(samples_[k]) < squared(samples_[nearest])) nearest = k;
  return place_near(x, y, static_cast<double>(nearest) * spacing_);
}

// Newton's steps: the derivative of the way along the line is 1 - k offset.
LinePlace Road::place_near(double x, double y, double station) const {
  LinePlace place{station, 0.0};
  for (int k = 0; k < kRefinements; ++k) {
    const auto [pose, curvature, change] = line_at(place.station);
    const double dx = x - pose.x, dy = y - pose.y, c = std::cos(pose.heading), s = std::sin(pose.heading);
    place.offset = c * dy - s * dx;
    const double along = c * dx + s * dy, step = along / std::max(0.2, 1.0 - curvature * place.offset);
    place.station += step;
    if (std::abs(step) < 1e-10) break;
  }
  if (config_.closed) place.station -= length_ * std::floor(place.station / length_);
  return place;
}

double Road::ahead(double from, double to) const {
  return config_.closed ? std::remainder(to - from, length_) : to - from;
}

Mark Road::mark_at(std::size_t mark, const Pose& vehicle, double ahead) const {
  const double side = (static_cast<double>(mark) - config_.right) * config_.lane_width;
  const double c = std::cos(vehicle.heading), s = std::sin(vehicle.heading);
  double station = place_of(vehicle.x, vehicle.y).station;
  Mark seen;
  seen.solid = mark == 0 || mark + 1 == marks();
  // The point of the mark at the vehicle's x = ahead, by Newton's steps.
  for (int k = 0; k < kRefinements; ++k) {
    const LinePoint line = line_at(station);
    const double x = line.pose.x - side * std::sin(line.pose.heading) - vehicle.x,
                 y = line.pose.y + side * std::cos(line.pose.heading) - vehicle.y;
    const double stretch = 1.0 - line.curvature * side;
    seen.offset = c * y - s * x;
    seen.heading = std::remainder(line.pose.heading - vehicle.heading, 2.0 * std::numbers::pi);
    seen.curvature = line.curvature / stretch;
    // A vehicle that drives against the line sees the mark from its other end.
    if (std::cos(seen.heading) < 0.0) {
      seen.heading = std::remainder(seen.heading + std::numbers::pi, 2.0 * std::numbers::pi);
      seen.curvature = -seen.curvature;
    }
    const double slope = std::cos(line.pose.heading - vehicle.heading) * std::max(0.2, stretch);
    if (std::abs(slope) < 0.1) break;
    const double step = (ahead - (c * x + s * y)) / slope;
    station += step;
    if (std::abs(step) < 1e-10) break;
  }
  return seen;
}

}  // namespace ttf::sim::world::road
