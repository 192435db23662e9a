#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
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
  object.speed = map.number_or("speed", 0.0, {0.0, 100.0}, "m/s");
  object.length = map.number_or("length", object.length, {0.1, 30.0}, "m");
  object.width = map.number_or("width", object.width, {0.1, 5.0}, "m");
}

double load_heading(YamlMap& map) { return map.number_or("heading", 0.0, {-7.0, 7.0}, "rad"); }

void load_class(YamlMap& map, ObjectConfig& object) {
  Choices<traffic::ObjectClass> classes;
  for (std::size_t k = 0; k < traffic::kClasses.size(); ++k)
    classes.emplace_back(traffic::kClasses[k].name, static_cast<traffic::ObjectClass>(k));
  object.kind = map.choice_or("class", object.kind, classes);
  const traffic::ClassTraits& usual = traffic::traits_of(object.kind);
  object.length = usual.length;
  object.width = usual.width;
  object.height = map.number_or("height", usual.height, {0.1, 5.0}, "m");
  object.cross_section = map.number_or("cross_section", usual.cross_section, {0.001, 10'000.0}, "m^2");
}

TrajectorySegment load_segment(YamlMap& map) {
  TrajectorySegment segment;
  segment.duration = map.duration("duration", {Duration::milliseconds(1), Duration::milliseconds(3'600'000)});
  const traffic::Pace pace = traffic::load_pace(map);
  segment.acceleration = pace.speed ? pace.size() : pace.acceleration.value_or(0.0);
  segment.speed = pace.speed;
  segment.yaw_rate = map.number_or("yaw_rate", 0.0, {-5.0, 5.0}, "rad/s");
  map.finish();
  return segment;
}

void load_field(YamlMap& map, const SizeConfig& size, std::vector<ObjectConfig>& objects) {
  FieldConfig field;
  field.objects = static_cast<int>(map.integer("objects", {1, 5000}));
  field.nearest = map.number_or("nearest", field.nearest, {1.0, kFarthest_m}, "m");
  field.row = map.number_or("row", field.row, {0.5, kFarthest_m}, "m");
  field.across = map.number_or("across", field.across, {0.5, kFarthest_m}, "m");
  field.half_angle = map.number_or("half_angle", field.half_angle, {0.0, 1.4}, "rad");
  field.each.heading = load_heading(map);
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
    return !object.on && object.heading == 0.0 &&
           std::all_of(object.segments.begin(), object.segments.end(),
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
  if (auto road = yaml.map_if("road")) config.road = road::load_road(*road);
  const road::RoadConfig* road = config.road ? &*config.road : nullptr;
  if (auto ego = yaml.map_if("ego")) config.ego = vehicle::load_ego(*ego, road);
  for (YamlMap& light : yaml.maps_if("traffic_lights")) config.lights.push_back(traffic::load_light(light, road));
  if (config.ego && config.own_speed != 0.0)
    yaml.fail("own_speed", "must be 0 or absent beside an ego, which has a speed of its own");
  SizeConfig size;
  if (auto all = yaml.map_if("size")) size = load_size(*all);
  std::map<std::string, std::size_t> places;  // in `objects`, by name
  for (YamlMap& map : yaml.maps_if("objects")) {
    ObjectConfig object;
    object.name = map.text("name");
    const auto [same, added] = places.try_emplace(object.name, config.objects.size());
    if (!added && !object.name.empty())
      map.fail("name", fmt::format("must differ from the name of objects[{}]", same->second));
    load_class(map, object);
    load_kind(map, object);
    if (auto on = map.map_if("at")) {
      if (!config.road) map.fail("at", "needs a road in the world");
      object.on = traffic::load_lane_config(map, *on, config.road.value_or(road::kMissingRoad));
    } else {
      object.x = map.number("x", kPlace, "m");
      object.y = map.number("y", kPlace, "m");
      object.heading = load_heading(map);
      for (YamlMap& segment : map.maps_if("segments")) object.segments.push_back(load_segment(segment));
    }
    // A drawn size is a car's.
    if (object.kind == traffic::ObjectClass::kCar) object.size = size;
    if (auto own = map.map_if("size")) object.size = load_size(*own);
    object.reference = map.boolean_or("reference", false);
    const bool second = object.reference && std::any_of(config.objects.begin(), config.objects.end(),
                                                        [](const ObjectConfig& other) { return other.reference; });
    if (second) map.fail("reference", "at most one object carries the reference's antenna");
    map.finish();
    config.objects.push_back(std::move(object));
  }
  if (auto field = yaml.map_if("field")) load_field(*field, size, config.objects);
  if (config.own_speed != 0.0 && !config.ego && !drive_along_x(config))
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
