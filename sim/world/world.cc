#include "sim/world/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/random.h"
#include "sim/world/speed.h"

namespace ttf::sim::world {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;
constexpr double kStep_s = 1e-9 * static_cast<double>(kStep_ns);

// Integrates cos and sin of the heading, weighed with speed: position after dt, speed v + a t, heading h + w t.
void advance_position(ObjectState& state, double dt) {
  const double v = state.speed, a = state.acceleration, w = state.yaw_rate, h = state.heading;
  const double turn = w * dt;
  double along, across;  // in the frame of the initial heading
  if (std::abs(turn) < 1e-3) {
    // Series in the turn angle, to the second order: exact to 1e-10 m for a car within a step.
    along = v * dt * (1.0 - turn * turn / 6.0) + a * dt * dt * (0.5 - turn * turn / 8.0);
    across = v * dt * turn * 0.5 + a * dt * dt * turn / 3.0;
  } else {
    const double s = std::sin(turn), c = std::cos(turn);
    along = (v + a * dt) * s / w + a * (c - 1.0) / (w * w);
    across = (v - (v + a * dt) * c) / w + a * s / (w * w);
  }
  state.x += std::cos(h) * along - std::sin(h) * across;
  state.y += std::sin(h) * along + std::cos(h) * across;
}

// Returns the object in the vehicle's axes. Values over ground remain so.
ObjectState seen_from(const EgoState& ego, ObjectState state) {
  const double c = std::cos(ego.heading), s = std::sin(ego.heading), x = state.x - ego.x, y = state.y - ego.y;
  state.x = c * x + s * y;
  state.y = c * y - s * x;
  state.heading = std::remainder(state.heading - ego.heading, 2.0 * std::numbers::pi);
  return state;
}

RandomStream noise_of(const ObjectKey& key) {
  return RandomStream(
      {key.seed, key.replication, Purpose::kTrajectory, static_cast<std::uint16_t>(index_of(key.object)), 0});
}

// Returns what is constant through the drive.
ObjectState at_start(const ObjectConfig& object, const ObjectKey& key) {
  ObjectState state;
  state.id = key.object;
  const Size size = drawn_size(object.size, {object.length, object.width}, key);
  state.length = size.length;
  state.width = size.width;
  state.height = object.height;
  state.cross_section = object.cross_section;
  state.kind = object.kind;
  return state;
}

double acceleration_of(const TrajectorySegment& segment, double speed) {
  if (!segment.speed) return segment.acceleration;
  return std::clamp((*segment.speed - speed) / kStep_s, -segment.acceleration, segment.acceleration);
}

// Returns the sensors' vehicle as one that follows it sees it: a car whose rear is a metre behind its rear axle.
traffic::Vehicle ego_on_road(const road::Road& road, const EgoState& ego) {
  const road::LinePlace place = road.place_of(ego.x, ego.y);
  const double along = std::cos(ego.heading - road.line_at(place.station).pose.heading);
  return {place, along < 0.0 ? -1.0 : 1.0, ego.vx, 2.0, 1.8};
}

}  // namespace

ObjectState moved(const ObjectState& start, double dt) {
  ObjectState state = start;
  // A braking car stops; it neither drives backwards nor turns on the spot.
  double moving = dt;
  if (state.speed + state.acceleration * dt < 0.0)
    moving = state.acceleration < 0.0 ? std::clamp(-state.speed / state.acceleration, 0.0, dt) : 0.0;
  advance_position(state, moving);
  state.heading += state.yaw_rate * moving;
  state.speed = std::max(0.0, state.speed + state.acceleration * moving);
  if (moving < dt) state.speed = 0.0;
  return state;
}

World::World(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication) : own_speed_(config.own_speed) {
  if (config.road) road_.emplace(*config.road);
  for (const traffic::LightConfig& light : config.lights)
    lights_.push_back(light.on ? traffic::placed(light, *road_) : light);
  if (config.ego && config.ego->actuator)
    driven_ = std::make_unique<vehicle::Driven>(*config.ego, road(), config.duration);
  else if (config.ego)
    ego_.emplace(*config.ego, road(), config.duration);
  const auto steps = static_cast<std::size_t>(config.duration.ns / kStep_ns + 2);
  for (std::size_t o = 0; o < config.objects.size(); ++o) {
    const ObjectConfig& object = config.objects[o];
    const ObjectKey key{seed, replication, static_cast<ObjectId>(o)};
    std::vector<ObjectState>& trajectory = trajectories_.emplace_back();
    trajectory.reserve(steps);
    if (object.on) continue;  // they drive together
    RandomStream noise = noise_of(key);
    ObjectState state = at_start(object, key);
    state.x = object.x;
    state.y = object.y;
    state.heading = object.heading;
    Speed speed(config, object.speed, key, kStep_s);
    state.speed = speed.at_start();
    std::size_t segment = 0;
    std::int64_t segment_end = object.segments.empty() ? 0 : object.segments[0].duration.ns;
    for (std::size_t k = 0; k < steps; ++k) {
      const auto now = static_cast<std::int64_t>(k) * kStep_ns;
      while (segment < object.segments.size() && now >= segment_end) {
        ++segment;
        if (segment < object.segments.size()) segment_end += object.segments[segment].duration.ns;
      }
      const bool steered = segment < object.segments.size();
      const double acceleration_noise = noise.normal(), yaw_rate_noise = noise.normal();
      const double profile = steered ? acceleration_of(object.segments[segment], state.speed) : 0.0;
      // A standing car that does not want to drive has none.
      state.steady = speed.steady(profile);
      if (state.speed <= 0.0) state.steady = std::max(0.0, state.steady);
      state.acceleration = speed.acceleration(profile, acceleration_noise, state.speed);
      state.yaw_rate = (steered ? object.segments[segment].yaw_rate : 0.0) + config.yaw_rate_noise * yaw_rate_noise;
      trajectory.push_back(state);
      state = moved(state, kStep_s);
    }
  }
  drive_on_lanes(config, seed, replication, steps);
}

// They see each other at the beginning of each step.
void World::drive_on_lanes(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication,
                           std::size_t steps) {
  struct Driven {
    traffic::LaneDriver driver;
    Speed speed;
    RandomStream noise;
    ObjectState state;
  };
  std::vector<Driven> all;
  for (std::size_t o = 0; o < config.objects.size(); ++o) {
    const ObjectConfig& object = config.objects[o];
    if (!object.on) continue;
    TTF_CHECK(road_, "object {} on a lane of no road", object.name);
    const ObjectKey key{seed, replication, static_cast<ObjectId>(o)};
    const Speed speed(config, object.speed, key, kStep_s);
    all.push_back({{*object.on, *road_, speed.at_start()}, speed, noise_of(key), at_start(object, key)});
  }
  if (all.empty()) return;
  std::vector<traffic::Vehicle> others;
  for (std::size_t k = 0; k < steps; ++k) {
    const Duration now{static_cast<std::int64_t>(k) * kStep_ns};
    others.clear();
    for (const Driven& one : all)
      others.push_back(
          {one.driver.place(), one.driver.direction(), one.driver.speed(), one.state.length, one.state.width});
    if (ego_) others.push_back(ego_on_road(*road_, ego_at(TrueTime{} + now)));
    for (const traffic::LightConfig& light : lights_)
      if (light.on && traffic::stops(traffic::shown_at(light, TrueTime{} + now)))
        others.push_back({{light.on->station, road_->middle(light.on->lane)}});
    for (std::size_t i = 0; i < all.size(); ++i) {
      auto& [driver, speed, noise, state] = all[i];
      const double wanted = driver.wanted(now, others, i), drawn = noise.normal();
      state.steady = speed.steady(wanted);
      if (driver.speed() <= 0.0) state.steady = std::max(0.0, state.steady);
      state.acceleration = std::max(speed.acceleration(wanted, drawn, driver.speed()), -driver.speed() / kStep_s);
      state.speed = driver.speed();
      const road::Pose pose = driver.pose();
      state.x = pose.x;
      state.y = pose.y;
      state.heading = pose.heading;
      driver.advance(state.acceleration, kStep_s);
      // The rate that leads to the next heading.
      state.yaw_rate = std::remainder(driver.pose().heading - pose.heading, 2.0 * std::numbers::pi) / kStep_s;
      trajectories_[index_of(state.id)].push_back(state);
    }
  }
}

ObjectState World::over_ground(ObjectId object, TrueTime since_start) const {
  TTF_CHECK(index_of(object) < trajectories_.size(), "object {} of {}", index_of(object), trajectories_.size());
  const std::vector<ObjectState>& trajectory = trajectories_[index_of(object)];
  const std::int64_t at = std::max<std::int64_t>(0, since_start.ns);
  const auto step = std::min(static_cast<std::size_t>(at / kStep_ns), trajectory.size() - 1);
  ObjectState state =
      moved(trajectory[step], 1e-9 * static_cast<double>(at - static_cast<std::int64_t>(step) * kStep_ns));
  if (own_speed_ != 0.0) {
    state.x -= own_speed_ * (1e-9 * static_cast<double>(at));
    state.speed -= own_speed_;
  }
  return state;
}

ObjectState World::state_of(ObjectId object, TrueTime since_start) const {
  const ObjectState state = over_ground(object, since_start);
  return ego_ || driven_ ? seen_from(ego_at(since_start), state) : state;
}

EgoState World::ego_at(TrueTime since_start) const {
  if (!ego_ && !driven_) return {};
  const vehicle::RearAxleMotion ego = driven_ ? driven_->at(since_start) : ego_->at(since_start);
  return {ego.x, ego.y, ego.heading, ego.vx, ego.vy, ego.yaw_rate, ego.acceleration};
}

void World::states_at(TrueTime since_start, std::vector<ObjectState>& out) const {
  out.clear();
  for (std::size_t o = 0; o < trajectories_.size(); ++o)
    out.push_back(over_ground(static_cast<ObjectId>(o), since_start));
  if (!ego_ && !driven_) return;
  const EgoState ego = ego_at(since_start);
  for (ObjectState& state : out) state = seen_from(ego, state);
}

}  // namespace ttf::sim::world
