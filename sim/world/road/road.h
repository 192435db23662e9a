// A road: a line of pieces, with lanes of one width to either side of it, and marks between them.
//
// The line's curvature is linear along each piece: zero for a straight, constant for an arc, changing for a clothoid. With k0 and
// k' at a piece's beginning,
//   h(s) = h0 + k0 s + k' s^2 / 2,   x(s) = x0 + int_0^s cos h,   y(s) = y0 + int_0^s sin h.
// Straights and arcs have closed forms. Clothoids are cut into parts that turn by at most half a radian, each integrated by
// Gauss and Legendre's rule of eight points. The error is below 1e-9 m. Each piece begins where the last one ends, without a bend.
// Curvatures may jump.
//
// A station s is the length along the line [m]. An offset is the distance to its left [m]. Before its beginning and after its end
// a road goes straight on, with its lanes. The end of a closed road is its beginning.
//
// Lanes are numbered as in OpenDRIVE: 1, 2, ... from the line to the left, -1, -2, ... to the right. Traffic keeps to the right.
// It drives along the line on the right lanes, and against it on the left ones.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"

namespace ttf::sim::world::road {

struct Piece {
  double length = 0.0;     // [m]
  double curvature = 0.0;  // [1/m], at its beginning
  double change = 0.0;     // [1/m^2], of the curvature along the piece
};

struct RoadConfig {
  double x = 0.0, y = 0.0, heading = 0.0;  // the line's beginning
  std::vector<Piece> pieces;
  int left = 0, right = 1;  // lanes to either side
  double lane_width = 3.5;  // [m]
  bool closed = false;
};
// Stands for a road that a file lacks, once a finding has said so. It has every lane, so that no second finding follows.
inline const RoadConfig kMissingRoad{.pieces = {Piece{1.0}}, .left = 8, .right = 8};
// Reads the road, and checks that a closed one ends where it begins.
RoadConfig load_road(YamlMap& yaml);
// Reads the number of one of the road's lanes.
int load_lane(YamlMap& yaml, std::string_view key, const RoadConfig& road);

// The middle of a lane: where something starts or stands.
struct OnLane {
  int lane = -1;
  double station = 0.0;
};
// Reads `lane` and `s`.
OnLane load_on_lane(YamlMap& yaml, const RoadConfig& road);

struct Pose {
  double x = 0.0, y = 0.0, heading = 0.0;
};

// Returns the pose of the line's end.
Pose end_of(const RoadConfig& road);

struct LinePlace {
  double station = 0.0, offset = 0.0;
};

// The line at a station.
struct LinePoint {
  Pose pose;
  double curvature = 0.0, change = 0.0;
};

// A mark as a vehicle sees it, at a distance ahead: how far it is to the left of the vehicle's x axis, its heading, and its
// curvature. A solid mark ends the road, a broken one separates lanes.
struct Mark {
  double offset = 0.0;     // [m]
  double heading = 0.0;    // [rad], from the vehicle's x axis
  double curvature = 0.0;  // [1/m]
  bool solid = false;
};

class Road {
 public:
  explicit Road(const RoadConfig& config);

  double length() const { return length_; }
  bool closed() const { return config_.closed; }
  int lanes() const { return config_.left + config_.right; }
  // Returns the offset of a lane's middle.
  double middle(int lane) const { return (lane > 0 ? lane - 0.5 : lane + 0.5) * config_.lane_width; }
  // Returns 1 for a lane that is driven along the line, -1 for one that is driven against it.
  static double direction(int lane) { return lane > 0 ? -1.0 : 1.0; }

  LinePoint line_at(double station) const;
  // Returns the pose of a point beside the line, with the line's heading.
  Pose pose_at(const LinePlace& place) const;
  // Returns the place of the nearest point on the line. On a closed road, stations are 0..length.
  LinePlace place_of(double x, double y) const;
  // Returns the same for a point near to `station`, without a search.
  LinePlace place_near(double x, double y, double station) const;
  // Returns how far `to` lies ahead of `from`, along the line [m]; on a closed road -length / 2..length / 2.
  double ahead(double from, double to) const;

  std::size_t marks() const { return static_cast<std::size_t>(lanes() + 1); }
  // Returns mark 0..marks() - 1, from right to left, `ahead` of a vehicle [m]. It must be less than a quarter turn of the road away.
  Mark mark_at(std::size_t mark, const Pose& vehicle, double ahead) const;

 private:
  struct Beginning {
    double station;
    Pose pose;
  };
  RoadConfig config_;
  std::vector<Beginning> beginnings_;  // by piece
  double length_ = 0.0;
  Pose end_;
  std::vector<Pose> samples_;  // along the line, for the search
  double spacing_ = 1.0;       // [m], between samples
};

}  // namespace ttf::sim::world::road
