#include "sim/world/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"

namespace ttf::sim::world {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;

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

World::World(const WorldConfig& config, std::uint64_t seed, std::uint32_t replication) {
  const auto steps = static_cast<std::size_t>(config.duration.ns / kStep_ns + 2);
  for (std::size_t o = 0; o < config.objects.size(); ++o) {
    const ObjectConfig& object = config.objects[o];
    RandomStream noise({seed, replication, Purpose::kTrajectory, static_cast<std::uint16_t>(o), 0});
    ObjectState state;
    state.id = static_cast<ObjectId>(o);
    state.x = object.x;
    state.y = object.y;
    state.heading = object.heading;
    state.speed = object.speed;
    state.length = object.length;
    state.width = object.width;
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
      state.acceleration =
          (steered ? object.segments[segment].acceleration : 0.0) + config.acceleration_noise * acceleration_noise;
      state.yaw_rate = (steered ? object.segments[segment].yaw_rate : 0.0) + config.yaw_rate_noise * yaw_rate_noise;
      trajectory.push_back(state);
      state = moved(state, 1e-9 * static_cast<double>(kStep_ns));
    }
    trajectories_.push_back(std::move(trajectory));
  }
}

ObjectState World::state_of(ObjectId object, TrueTime since_start) const {
  TTF_CHECK(index_of(object) < trajectories_.size(), "object {} of {}", index_of(object), trajectories_.size());
  const std::vector<ObjectState>& trajectory = trajectories_[index_of(object)];
  const std::int64_t at = std::max<std::int64_t>(0, since_start.ns);
  const auto step = std::min(static_cast<std::size_t>(at / kStep_ns), trajectory.size() - 1);
  return moved(trajectory[step], 1e-9 * static_cast<double>(at - static_cast<std::int64_t>(step) * kStep_ns));
}

void World::states_at(TrueTime since_start, std::vector<ObjectState>& out) const {
  out.clear();
  for (std::size_t o = 0; o < trajectories_.size(); ++o) out.push_back(state_of(static_cast<ObjectId>(o), since_start));
}

namespace {

constexpr Range<double> kPlace{-kFarthest_m, kFarthest_m};
constexpr std::int64_t kMostObjects = 65'534;  // whose ids are no false detection's

// Loads an object without its place.
void load_kind(YamlMap& map, ObjectConfig& object) {
  object.heading = map.number_or("heading", 0.0, {-7.0, 7.0}, "rad");
  object.speed = map.number_or("speed", 0.0, {0.0, 100.0}, "m/s");
  object.length = map.number_or("length", object.length, {0.1, 30.0}, "m");
  object.width = map.number_or("width", object.width, {0.1, 5.0}, "m");
}

void load_field(YamlMap& map, std::vector<ObjectConfig>& objects) {
  FieldConfig field;
  field.objects = static_cast<int>(map.integer("objects", {1, 5000}));
  field.nearest = map.number_or("nearest", field.nearest, {1.0, kFarthest_m}, "m");
  field.row = map.number_or("row", field.row, {0.5, kFarthest_m}, "m");
  field.across = map.number_or("across", field.across, {0.5, kFarthest_m}, "m");
  field.half_angle = map.number_or("half_angle", field.half_angle, {0.0, 1.4}, "rad");
  load_kind(map, field.each);
  const std::vector<ObjectConfig> all = placed(field);
  if (all.size() < static_cast<std::size_t>(field.objects))
    map.fail("objects", fmt::format("must be at most {}: rows end {} m away", all.size(), kFarthest_m));
  objects.insert(objects.end(), all.begin(), all.end());
  map.finish();
}

}  // namespace

WorldConfig load_world(YamlMap& yaml) {
  WorldConfig config;
  config.acceleration_noise = yaml.number_or("acceleration_noise", 0.0, {0.0, 50.0}, "m/s^2");
  config.yaw_rate_noise = yaml.number_or("yaw_rate_noise", 0.0, {0.0, 5.0}, "rad/s");
  for (YamlMap& map : yaml.maps_if("objects")) {
    ObjectConfig object;
    object.name = map.text("name");
    object.x = map.number("x", kPlace, "m");
    object.y = map.number("y", kPlace, "m");
    load_kind(map, object);
    object.reference = map.boolean_or("reference", false);
    for (YamlMap& segment : map.maps_if("segments")) {
      object.segments.push_back(
          {segment.duration("duration", {Duration::milliseconds(1), Duration::milliseconds(3'600'000)}),
           segment.number_or("acceleration", 0.0, {-20.0, 20.0}, "m/s^2"),
           segment.number_or("yaw_rate", 0.0, {-5.0, 5.0}, "rad/s")});
      segment.finish();
    }
    const bool second = object.reference && std::any_of(config.objects.begin(), config.objects.end(),
                                                        [](const ObjectConfig& other) { return other.reference; });
    if (second) map.fail("reference", "at most one object carries the reference's antenna");
    map.finish();
    config.objects.push_back(std::move(object));
  }
  if (auto field = yaml.map_if("field")) load_field(*field, config.objects);
  const auto all = static_cast<std::int64_t>(config.objects.size());
  const Range<std::int64_t> there{std::min<std::int64_t>(all, 1), all};
  std::int64_t count = yaml.integer_or("object_count", all, {0, kMostObjects});
  if (!there.contains(count)) {
    yaml.fail("object_count", fmt::format("must be {}..{}: so many objects there are", there.low, there.high));
    count = std::clamp(count, there.low, there.high);
  }
  const auto reference = std::find_if(config.objects.begin(), config.objects.end(),
                                      [](const ObjectConfig& object) { return object.reference; });
  if (reference != config.objects.end() && reference - config.objects.begin() >= count)
    yaml.fail("object_count", "must leave the object that carries the reference's antenna");
  config.objects.resize(static_cast<std::size_t>(count));
  return config;
}

}  // namespace ttf::sim::world
