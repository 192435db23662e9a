#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "sim/world/world.h"

namespace ttf::sim::world {
namespace {

constexpr Range<double> kPlace{-kFarthest_m, kFarthest_m};
constexpr Range<Duration> kMemory{Duration::milliseconds(20), Duration::milliseconds(3'600'000)};
constexpr std::int64_t kMostObjects = 65'534;  // whose ids are no false detection's

// Loads an object without its place, and without what draws its size.
void load_kind(YamlMap& map, ObjectConfig& object) {
  object.heading = map.number_or("heading", 0.0, {-7.0, 7.0}, "rad");
  object.speed = map.number_or("speed", 0.0, {0.0, 100.0}, "m/s");
  object.length = map.number_or("length", object.length, {0.1, 30.0}, "m");
  object.width = map.number_or("width", object.width, {0.1, 5.0}, "m");
}

void load_field(YamlMap& map, const SizeConfig& size, std::vector<ObjectConfig>& objects) {
  FieldConfig field;
  field.objects = static_cast<int>(map.integer("objects", {1, 5000}));
  field.nearest = map.number_or("nearest", field.nearest, {1.0, kFarthest_m}, "m");
  field.row = map.number_or("row", field.row, {0.5, kFarthest_m}, "m");
  field.across = map.number_or("across", field.across, {0.5, kFarthest_m}, "m");
  field.half_angle = map.number_or("half_angle", field.half_angle, {0.0, 1.4}, "rad");
  load_kind(map, field.each);
  field.each.size = size;
  const std::vector<ObjectConfig> all = placed(field);
  if (all.size() < static_cast<std::size_t>(field.objects))
    map.fail("objects", fmt::format("must be at most {}: rows end {} m away", all.size(), kFarthest_m));
  objects.insert(objects.end(), all.begin(), all.end());
  map.finish();
}

// An object's state has a speed along its heading only: relative to a vehicle that drives, too, it must have no other.
bool drive_along_x(const WorldConfig& config) {
  const auto does = [](const ObjectConfig& object) {
    return object.heading == 0.0 && std::all_of(object.segments.begin(), object.segments.end(),
                                                [](const TrajectorySegment& s) { return s.yaw_rate == 0.0; });
  };
  return config.yaw_rate_noise == 0.0 && std::all_of(config.objects.begin(), config.objects.end(), does);
}

}  // namespace

WorldConfig load_world(YamlMap& yaml) {
  WorldConfig config;
  config.acceleration_noise = yaml.number_or("acceleration_noise", 0.0, {0.0, 50.0}, "m/s^2");
  config.yaw_rate_noise = yaml.number_or("yaw_rate_noise", 0.0, {0.0, 5.0}, "rad/s");
  if (yaml.has("speed_memory")) config.speed_memory = yaml.duration("speed_memory", kMemory);
  config.own_speed = yaml.number_or("own_speed", 0.0, {0.0, 100.0}, "m/s");
  SizeConfig size;
  if (auto all = yaml.map_if("size")) size = load_size(*all);
  for (YamlMap& map : yaml.maps_if("objects")) {
    ObjectConfig object;
    object.name = map.text("name");
    object.x = map.number("x", kPlace, "m");
    object.y = map.number("y", kPlace, "m");
    load_kind(map, object);
    object.size = size;
    if (auto own = map.map_if("size")) object.size = load_size(*own);
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
  if (auto field = yaml.map_if("field")) load_field(*field, size, config.objects);
  if (config.own_speed != 0.0 && !drive_along_x(config))
    yaml.fail("own_speed", "must be 0, since an object turns or does not head along x");
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
