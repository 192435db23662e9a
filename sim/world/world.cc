#include "sim/world/world.h"

#include <algorithm>
#include <cmath>

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
  const auto steps = static_cast<std::size_t>(config.duration.ns / kStep_ns + 2);
  for (std::size_t o = 0; o < config.objects.size(); ++o) {
    const ObjectConfig& object = config.objects[o];
    RandomStream noise({seed, replication, Purpose::kTrajectory, static_cast<std::uint16_t>(o), 0});
    ObjectState state;
    state.id = static_cast<ObjectId>(o);
    state.x = object.x;
    state.y = object.y;
    state.heading = object.heading;
    const Size size = drawn_size(object.size, {object.length, object.width}, {seed, replication, state.id});
    state.length = size.length;
    state.width = size.width;
    Speed speed(config, object.speed, {seed, replication, state.id}, kStep_s);
    state.speed = speed.at_start();
    std::vector<ObjectState> trajectory;
    trajectory.reserve(steps);
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
      const double profile = steered ? object.segments[segment].acceleration : 0.0;
      // A standing car that does not want to drive has none.
      state.steady = speed.steady(profile);
      if (state.speed <= 0.0) state.steady = std::max(0.0, state.steady);
      state.acceleration = speed.acceleration(profile, acceleration_noise, state.speed);
      state.yaw_rate = (steered ? object.segments[segment].yaw_rate : 0.0) + config.yaw_rate_noise * yaw_rate_noise;
      trajectory.push_back(state);
      state = moved(state, kStep_s);
    }
    trajectories_.push_back(std::move(trajectory));
  }
}

ObjectState World::state_of(ObjectId object, TrueTime since_start) const {
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

void World::states_at(TrueTime since_start, std::vector<ObjectState>& out) const {
  out.clear();
  for (std::size_t o = 0; o < trajectories_.size(); ++o) out.push_back(state_of(static_cast<ObjectId>(o), since_start));
}

}  // namespace ttf::sim::world
