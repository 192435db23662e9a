// A vehicle's place in its lane, by the truth: the offset of the front axle's middle, and the heading.
#pragma once

#include <cstdint>

#include "recording/records/records.h"
#include "sim/world/road/road.h"

namespace ttf::evaluation::driving {

struct LaneConfig {
  sim::world::road::RoadConfig road;
  int lane = -1;
  double front_axle_m = 2.58;  // ahead of the rear one
  double width_m = 1.8;        // the vehicle's
};

struct InLane {
  double offset = 0.0;   // [m], to the left of the lane's middle
  double heading = 0.0;  // [rad], from the lane's direction
};

class TrueLane {
 public:
  explicit TrueLane(const LaneConfig& config) : config_(config), road_(config.road) {}
  InLane place_of(const recording::records::EgoTruth& ego) const;
  // Returns whether a side of the vehicle is beyond its mark.
  bool left_by(const InLane& place) const;

 private:
  LaneConfig config_;
  sim::world::road::Road road_;
};

struct LaneFindings {
  double offset_rms_m = 0.0, largest_offset_m = 0.0;
  double heading_rms_rad = 0.0, largest_heading_rad = 0.0;
  double outside = 0.0;  // share of the moments in which a side is beyond its mark
};

class LaneAccount {
 public:
  explicit LaneAccount(const LaneConfig& config) : lane_(config) {}
  // Returns whether the vehicle leaves its lane at this moment.
  bool judge(const recording::records::EgoTruth& ego);
  LaneFindings findings() const;

 private:
  TrueLane lane_;
  LaneFindings sums_;  // squares, until the end
  std::uint64_t moments_ = 0, outside_ = 0;
};

}  // namespace ttf::evaluation::driving
