#include "sim/world/vehicle/journey.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "sim/world/road/lane_change.h"
#include "sim/world/road/road.h"
#include "sim/world/vehicle/single_track.h"

namespace ttf::sim::world::vehicle {
namespace {

// The way in which an error fades: a share of a second's, and at least as long as a car.
constexpr double kFading_s = 0.7, kShortestFading_m = 4.0;
constexpr double kSlow = 0.5;  // [m/s]: a slower vehicle does not change its lane

// Steers a vehicle along a lane.
class LaneKeeping {
 public:
  // Begins on a lane's middle, at the place where the vehicle is.
  LaneKeeping(const road::Road& road, int lane, const Parameters& vehicle, const Motion& motion)
      : road_(&road), change_(road.middle(lane)), lane_(lane), direction_(road::Road::direction(lane)) {
    const RearAxle axle = rear_axle(vehicle, motion);
    station_ = road.place_of(axle.x, axle.y).station;
  }

  // Changes to another lane; the vehicle keeps its direction.
  void change(int lane, Duration within) {
    if (lane == lane_) return;
    lane_ = lane;
    change_.begin(road_->middle(lane), within);
  }
  // Returns the yaw rate [rad/s] that keeps the vehicle to its lane, and goes on by `seconds`. In the
  // direction of driving: offsets count to the vehicle's left, curvatures to it.
  double yaw_rate(const Parameters& vehicle, const Motion& motion, double seconds) {
    const RearAxle axle = rear_axle(vehicle, motion);
    const road::LinePlace place = road_->place_near(axle.x, axle.y, station_);
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

 private:
  const road::Road* road_;
  road::LaneChange change_;
  int lane_;
  double direction_, station_;
};

constexpr std::int64_t kGrid_ns = 10'000'000;
constexpr double kGrid_s = 1e-9 * static_cast<double>(kGrid_ns);
constexpr Range<Duration> kChange{Duration::milliseconds(100), Duration::milliseconds(60'000)};

// The driver: what the segments say, with the lane that they follow.
class Driver {
 public:
  Driver(const EgoConfig& config, const road::Road* road) : config_(config), road_(road) {
    if (!config.segments.empty()) end_ = config.segments.front().duration;
  }

  // Returns the command for the step of the grid that begins now.
  Command command(Duration now, const Motion& motion) {
    while (segment_ < config_.segments.size() && now >= end_)
      if (++segment_ < config_.segments.size()) end_ = end_ + config_.segments[segment_].duration;
    const Segment* segment = segment_ < config_.segments.size() ? &config_.segments[segment_] : nullptr;
    if (now == Duration{} && config_.on) follow(config_.on->lane, Duration{}, motion);
    if (segment != last_ && segment) {
      if (segment->lane) follow(*segment->lane, segment->within, motion);
      if (segment->steering || segment->yaw_rate) lane_.reset();
    }
    last_ = segment;
    const double acceleration = segment ? segment->pace.wanted(motion.speed, kGrid_s) : 0.0;
    return {(steering(segment, motion) - motion.steering) / kGrid_s, std::max(acceleration, -motion.speed / kGrid_s)};
  }

 private:
  void follow(int lane, Duration within, const Motion& motion) {
    if (lane_)
      lane_->change(lane, within);
    else
      lane_ = std::make_unique<LaneKeeping>(*road_, lane, config_.vehicle, motion);
  }

  double steering(const Segment* segment, const Motion& motion) {
    if (lane_) {
      const double yaw_rate = lane_->yaw_rate(config_.vehicle, motion, kGrid_s);
      return motion.speed > 0.0 ? steering_for(config_.vehicle, yaw_rate, motion) : motion.steering;
    }
    if (segment && segment->yaw_rate) return steering_for(config_.vehicle, *segment->yaw_rate, motion);
    return segment ? segment->steering.value_or(0.0) : 0.0;
  }

  const EgoConfig& config_;
  const road::Road* road_;
  std::unique_ptr<LaneKeeping> lane_;  // not optional: g++ -O3 takes its members for uninitialised
  std::size_t segment_ = 0;
  const Segment* last_ = nullptr;
  Duration end_{};
};

Parameters load_vehicle(YamlMap& yaml) {
  Parameters v;
  const bool kinematic = yaml.choice_or("model", false, Choices<bool>{{"single_track", false}, {"kinematic", true}});
  v.front_axle = yaml.number_or("front_axle", v.front_axle, {0.2, 10.0}, "m");
  v.rear_axle = yaml.number_or("rear_axle", v.rear_axle, {0.2, 10.0}, "m");
  v.largest_steering = yaml.number_or("largest_steering", v.largest_steering, {0.01, 1.5}, "rad");
  v.largest_steering_rate = yaml.number_or("largest_steering_rate", v.largest_steering_rate, {0.01, 20.0}, "rad/s");
  v.fastest = yaml.number_or("fastest", v.fastest, {1.0, 100.0}, "m/s");
  v.largest_acceleration = yaml.number_or("largest_acceleration", v.largest_acceleration, {0.1, 30.0}, "m/s^2");
  v.full_power_speed = yaml.number_or("full_power_speed", v.full_power_speed, {0.5, 100.0}, "m/s");
  if (kinematic) {
    v.kinematic_below = std::numeric_limits<double>::infinity();
  } else {
    v.kinematic_below = yaml.number_or("kinematic_below", v.kinematic_below, {0.5, 100.0}, "m/s");
    v.mass = yaml.number_or("mass", v.mass, {100.0, 50'000.0}, "kg");
    v.yaw_inertia = yaml.number_or("yaw_inertia", v.yaw_inertia, {50.0, 1e6}, "kg m^2");
    v.height = yaml.number_or("height", v.height, {0.0, 3.0}, "m");
    v.friction = yaml.number_or("friction", v.friction, {0.05, 2.0});
    v.front_stiffness = yaml.number_or("front_stiffness", v.front_stiffness, {1.0, 40.0}, "1/rad");
    v.rear_stiffness = yaml.number_or("rear_stiffness", v.rear_stiffness, {1.0, 40.0}, "1/rad");
  }
  yaml.finish();
  return v;
}

const road::RoadConfig& needed(YamlMap& yaml, std::string_view key, const road::RoadConfig* road) {
  if (road == nullptr) yaml.fail(key, "needs a road in the world");
  return road == nullptr ? road::kMissingRoad : *road;
}

Segment load_segment(YamlMap& yaml, const road::RoadConfig* road) {
  Segment segment;
  segment.duration = yaml.duration("duration", {Duration::milliseconds(1), Duration::milliseconds(3'600'000)});
  segment.pace = traffic::load_pace(yaml);
  if (yaml.has("steering")) segment.steering = yaml.number("steering", {-1.5, 1.5}, "rad");
  if (yaml.has("yaw_rate")) segment.yaw_rate = yaml.number("yaw_rate", {-5.0, 5.0}, "rad/s");
  if (yaml.has("lane")) segment.lane = road::load_lane(yaml, "lane", needed(yaml, "lane", road));
  segment.within = yaml.duration_or("within", segment.within, kChange);
  if (segment.lane && (segment.steering || segment.yaw_rate))
    yaml.fail("lane", "must be absent beside `steering` and `yaw_rate`: a segment steers in one way");
  else if (segment.steering && segment.yaw_rate)
    yaml.fail("steering", "must be absent beside `yaw_rate`: a segment steers in one way");
  yaml.finish();
  return segment;
}

}  // namespace

EgoConfig load_ego(YamlMap& yaml, const road::RoadConfig* road) {
  EgoConfig config;
  if (auto vehicle = yaml.map_if("vehicle")) config.vehicle = load_vehicle(*vehicle);
  if (auto start = yaml.map_if("start")) {
    if (auto on = start->map_if("at")) {
      config.on = road::load_on_lane(*on, needed(*start, "at", road));
    } else {
      config.x = start->number_or("x", 0.0, {-10'000.0, 10'000.0}, "m");
      config.y = start->number_or("y", 0.0, {-10'000.0, 10'000.0}, "m");
      config.heading = start->number_or("heading", 0.0, {-7.0, 7.0}, "rad");
    }
    config.speed = start->number_or("speed", 0.0, {0.0, config.vehicle.fastest}, "m/s");
    start->finish();
  }
  for (YamlMap& segment : yaml.maps_if("profile")) config.segments.push_back(load_segment(segment, road));
  config.actuator_line = yaml.line("actuator");
  if (auto actuator = yaml.map_if("actuator")) {
    config.actuator = load_actuator(*actuator);
    if (!config.segments.empty()) yaml.fail("profile", "must be absent beside `actuator`: commands drive the vehicle");
  }
  config.front = yaml.number_or("front", config.front, {0.5, 15.0}, "m");
  config.width = yaml.number_or("width", config.width, {0.5, 4.0}, "m");
  yaml.finish();
  return config;
}

Motion start_of(const EgoConfig& config, const road::Road* road) {
  RearAxle start{config.x, config.y, 0.0, config.speed, config.heading};
  if (config.on) {
    const road::Pose pose = road->pose_at({config.on->station, road->middle(config.on->lane)});
    start.x = pose.x;
    start.y = pose.y;
    start.heading = pose.heading + (road::Road::direction(config.on->lane) < 0.0 ? std::numbers::pi : 0.0);
  }
  return without_slip(config.vehicle, start);
}

RearAxleMotion rear_axle_motion(const Parameters& vehicle, const Motion& now, const Command& command) {
  const RearAxle axle = rear_axle(vehicle, now);
  RearAxleMotion motion{axle.x, axle.y, axle.heading, axle.speed, 0.0, now.yaw_rate, 0.0};
  if (std::abs(now.speed) < vehicle.kinematic_below) {
    motion.acceleration = limited(vehicle, now.steering, now.speed, command).acceleration;
  } else {
    const Motion rate = rates(vehicle, now, command);
    motion.vy = now.speed * std::sin(now.slip) - vehicle.rear_axle * now.yaw_rate;
    motion.acceleration = rate.speed * std::cos(now.slip) - now.speed * std::sin(now.slip) * rate.slip;
  }
  return motion;
}

Journey::Journey(const EgoConfig& config, const road::Road* road, Duration duration) : vehicle_(config.vehicle) {
  const auto count = static_cast<std::size_t>(duration.ns / kGrid_ns + 2);
  steps_.reserve(count);
  Motion motion = start_of(config, road);
  Driver driver(config, road);
  for (std::size_t k = 0; k < count; ++k) {
    steps_.push_back({motion, driver.command(Duration{static_cast<std::int64_t>(k) * kGrid_ns}, motion)});
    motion = advanced(vehicle_, motion, steps_.back().command, kGrid_s);
    // Rounding leaves a rest of a standstill.
    if (std::abs(motion.speed) < 1e-9) motion.speed = 0.0;
  }
}

RearAxleMotion Journey::at(TrueTime since_start) const {
  const std::int64_t at = std::max<std::int64_t>(0, since_start.ns);
  const auto k = std::min(static_cast<std::size_t>(at / kGrid_ns), steps_.size() - 1);
  const auto& [start, command] = steps_[k];
  const Motion now =
      advanced(vehicle_, start, command, 1e-9 * static_cast<double>(at - static_cast<std::int64_t>(k) * kGrid_ns));
  return rear_axle_motion(vehicle_, now, command);
}

}  // namespace ttf::sim::world::vehicle
