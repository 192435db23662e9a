#include "sim/world/vehicle/lane_keeping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ttf::sim::world::vehicle {
namespace {

// The way in which an error fades: a share of a second's, and at least as long as a car.
constexpr double kFading_s = 0.7, kShortestFading_m = 4.0;
constexpr double kSlow = 0.5;  // [m/s]: a slower vehicle does not change its lane

}  // namespace

LaneKeeping::LaneKeeping(const road::Road& road, int lane, const Parameters& vehicle, const Motion& motion)
    : road_(&road), change_(road.middle(lane)), lane_(lane), direction_(road::Road::direction(lane)) {
  const RearAxle axle = rear_axle(vehicle, motion);
  station_ = road.place_of(axle.x, axle.y).station;
}

void LaneKeeping::change(int lane, Duration within) {
  if (lane == lane_) return;
  lane_ = lane;
  change_.begin(road_->middle(lane), within);
}

// In the direction of driving: offsets count to the vehicle's left, curvatures to it.
double LaneKeeping::yaw_rate(const Parameters& vehicle, const Motion& motion, double seconds) {
  const RearAxle axle = rear_axle(vehicle, motion);
  const road::Place place = road_->place_near(axle.x, axle.y, station_);
  station_ = place.station;
  const road::LinePoint line = road_->line_at(station_);
  // The rear axle's way, with its slip.
  const double slip = std::atan2(motion.speed * std::sin(motion.slip) - vehicle.rear_axle * motion.yaw_rate,
                                 std::max(kSlow, motion.speed * std::cos(motion.slip)));
  const double heading = line.pose.heading + (direction_ < 0.0 ? std::numbers::pi : 0.0);
  const double speed = motion.speed;
  const bool moves = speed > kSlow;
  const double wanted_angle = moves ? direction_ * change_.rate() / speed : 0.0;
  const double angle = std::remainder(axle.heading + slip - heading, 2.0 * std::numbers::pi) - wanted_angle;
  const double off = direction_ * (place.offset - change_.offset());
  const double fading = std::max(kShortestFading_m, kFading_s * speed);
  double curvature = direction_ * line.curvature / (1.0 - line.curvature * place.offset);
  if (moves) curvature += direction_ * change_.second() / (speed * speed);
  curvature -= 2.0 * angle / fading + off / (fading * fading);
  if (moves) change_.advance(seconds);
  return curvature * speed;
}

}  // namespace ttf::sim::world::vehicle
