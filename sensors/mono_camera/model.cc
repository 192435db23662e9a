#include "sensors/mono_camera/model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/random.h"
#include "sensors/clutter.h"
#include "sensors/shape.h"

namespace ttf::sensors::mono_camera {
namespace {

constexpr std::size_t kClassCount = sim::world::traffic::kClasses.size();
constexpr double kClosest_m = 0.5;  // an outline nearer than this fills the picture

double row_of(const MonoCameraConfig& config, double depth, double height) {
  return config.focal_px * std::tan(std::atan((config.height_m - height) / depth) - config.pitch.fixed);
}

// The box without noise, and the line of sight to the middle of the silhouette.
struct Projected {
  MonoBox box;
  Sight sight;
};

std::optional<Projected> project(const ObjectState& state, const MonoCameraConfig& config) {
  const auto span = azimuth_span(state);
  if (!span || std::max(std::abs(span->low), std::abs(span->high)) > 1.5) return std::nullopt;
  double depth = std::numeric_limits<double>::infinity();
  for (const Corner& corner : corners(state)) depth = std::min(depth, corner.x);
  if (depth < kClosest_m) return std::nullopt;
  Projected seen;
  seen.box.left = -config.focal_px * std::tan(span->high);
  seen.box.right = -config.focal_px * std::tan(span->low);
  seen.box.bottom = row_of(config, depth, 0.0);
  seen.box.top = row_of(config, depth, state.height);
  seen.box.seen_as = state.kind;
  const double bearing = 0.5 * (span->low + span->high);
  seen.sight = {bearing, depth / std::cos(bearing), 0.5 * (span->high - span->low), true, false};
  return seen;
}

// The bottom must be in the picture: it gives the range.
bool in_view(const MonoCameraConfig& config, const MonoBox& box, double bearing) {
  if (std::abs(bearing) > config.half_field_rad || config.device.blind.hold(bearing) ||
      std::abs(box.bottom) > config.half_height_px)
    return false;
  if (config.region_count == 0) return true;
  const double column = 0.5 * (box.left + box.right), row = 0.5 * (box.top + box.bottom);
  return std::any_of(config.regions.begin(), config.regions.begin() + static_cast<std::ptrdiff_t>(config.region_count),
                     [&](const PictureRegion& region) { return region.holds(column, row); });
}

PictureRegion load_region(YamlMap& yaml) {
  constexpr Range<double> kPixels{-10000.0, 10000.0};
  PictureRegion region;
  const auto edge = [&](std::string_view key, double& value) {
    if (yaml.has(key)) value = yaml.number(key, kPixels, "px");
  };
  edge("left", region.left);
  edge("right", region.right);
  edge("top", region.top);
  edge("bottom", region.bottom);
  if (region.left > region.right) yaml.fail("right", "must be at least left");
  if (region.top > region.bottom) yaml.fail("bottom", "must be at least top: rows count downwards");
  yaml.finish();
  return region;
}

}  // namespace

MonoCameraConfig load_mono_camera(YamlMap& yaml) {
  MonoCameraConfig c;
  c.height_m = yaml.number_or("height", c.height_m, {0.2, 100.0}, "m");
  c.focal_px = yaml.number_or("focal", c.focal_px, {50.0, 20000.0}, "px");
  c.half_field_rad = yaml.number_or("half_field", c.half_field_rad, {0.01, 1.2}, "rad");
  c.half_height_px = yaml.number_or("half_height", c.half_height_px, {10.0, 10000.0}, "px");
  c.max_range_m = yaml.number_or("max_range", c.max_range_m, {1.0, 500.0}, "m");
  c.column_sigma_px = yaml.number_or("column_sigma", c.column_sigma_px, {0.0, 100.0}, "px");
  c.row_sigma_px = yaml.number_or("row_sigma", c.row_sigma_px, {0.0, 100.0}, "px");
  c.detection_probability = yaml.number_or("detection_probability", c.detection_probability, {0.0, 1.0});
  c.half_detected_px = yaml.number_or("half_detected", c.half_detected_px, {0.0, 1000.0}, "px");
  c.detection_slope_px = yaml.number_or("detection_slope", c.detection_slope_px, {0.01, 1000.0}, "px");
  c.class_confusion = yaml.number_or("class_confusion", c.class_confusion, {0.0, 1.0});
  c.clutter_per_frame = yaml.number_or("clutter_per_frame", c.clutter_per_frame, {0.0, 10.0});
  for (YamlMap& map : yaml.maps_if("regions")) {
    if (c.region_count == c.kMostRegions) {
      yaml.fail("regions", "must be at most 8 rectangles");
      break;
    }
    c.regions[c.region_count++] = load_region(map);
  }
  if (auto marks = yaml.map_if("marks")) {
    c.marks = load_lane_marks(*marks);
    marks->finish();
  }
  c.bearing_bias.fixed = yaml.number_or("bearing_bias", 0.0, {-0.2, 0.2}, "rad");
  c.bearing_bias.sigma = yaml.number_or("bearing_bias_sigma", 0.0, {0.0, 0.2}, "rad");
  c.pitch.fixed = yaml.number_or("pitch", 0.0, {-0.05, 0.05}, "rad");
  c.pitch.sigma = yaml.number_or("pitch_sigma", 0.0, {0.0, 0.02}, "rad");
  c.device = load_device(yaml);
  if (!c.device.enabled) {
    c.clutter_per_frame = c.marks.false_per_list = 0.0;
    c.marks.miss_probability = 1.0;
  }
  return c;
}

MonoCameraConfig in_weather(MonoCameraConfig camera, const sim::world::Weather& weather) {
  camera.max_range_m *= weather.camera_range;
  // A box shrinks with the range.
  camera.half_detected_px /= weather.camera_range;
  camera.detection_probability = std::max(0.0, 1.0 - (1.0 - camera.detection_probability) * weather.camera_misses);
  camera.clutter_per_frame *= weather.camera_clutter;
  return camera;
}

MonoCameraConfig in_drive(MonoCameraConfig config, const DriveKey& key) {
  config.bearing_bias = in_drive(config.bearing_bias, ErrorOf::kBearing, key);
  config.pitch = in_drive(config.pitch, ErrorOf::kPitch, key);
  config.device.time = in_drive(config.device.time, ErrorOf::kTime, key);
  return config;
}

double looked_at(const MonoCameraConfig& config) {
  if (config.region_count == 0) return config.half_field_rad;
  double furthest = 0.0;
  for (std::size_t r = 0; r < config.region_count; ++r)
    furthest = std::max({furthest, std::abs(config.regions[r].left), std::abs(config.regions[r].right)});
  return std::min(config.half_field_rad, std::atan(furthest / config.focal_px));
}

double probability_of_detection(const MonoCameraConfig& config, double height_px) {
  return config.detection_probability /
         (1.0 + std::exp(-(height_px - config.half_detected_px) / config.detection_slope_px));
}

void measure_mono_camera(const MonoCameraConfig& config, std::span<const ObjectState> objects,
                         const MeasurementKey& key, MonoCameraRoom& room, std::vector<MonoBox>& boxes,
                         std::vector<ObjectId>& truth) {
  boxes.clear();
  truth.clear();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto seen = project(objects[i], config);
    room.boxes[i] = seen ? seen->box : MonoBox{};
    room.sights[i] = seen ? seen->sight : Sight{};
    if (seen)
      room.sights[i].wanted =
          seen->sight.range <= config.max_range_m && in_view(config, seen->box, seen->sight.bearing);
  }
  // A camera no higher than the objects never sees over them.
  const std::span<const char> hidden = room.occlusion.hidden(objects, std::span(room.sights).first(objects.size()),
                                                             std::numeric_limits<double>::infinity());
  RandomStream noise(key.of(Purpose::kSensorNoise));
  RandomStream misses(key.of(Purpose::kSensorMisses));
  RandomStream clutter(key.of(Purpose::kClutter));
  const double shift = -config.focal_px * std::tan(config.bearing_bias.fixed);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    // Every object gets draws, seen or not, so one object's visibility never shifts another's noise.
    const double chance = misses.uniform(), confusion = misses.uniform(), other = misses.uniform();
    const double left = noise.normal(), right = noise.normal(), bottom = noise.normal(), top = noise.normal();
    if (!room.sights[i].wanted || hidden[i]) continue;
    const MonoBox& exact = room.boxes[i];
    if (chance >= probability_of_detection(config, exact.bottom - exact.top)) continue;
    if (static_cast<int>(boxes.size()) == config.max_boxes) continue;
    MonoBox box;
    // The ends stay a pixel apart.
    box.left = exact.left + shift + config.column_sigma_px * left;
    box.right = std::max(box.left + 1.0, exact.right + shift + config.column_sigma_px * right);
    box.bottom = exact.bottom + config.row_sigma_px * bottom;
    box.top = std::min(box.bottom - 1.0, exact.top + config.row_sigma_px * top);
    box.seen_as = exact.seen_as;
    if (confusion < config.class_confusion) {
      const auto step = 1 + static_cast<std::size_t>(other * (kClassCount - 1));
      box.seen_as =
          static_cast<sim::world::traffic::ObjectClass>((static_cast<std::size_t>(exact.seen_as) + step) % kClassCount);
    }
    boxes.push_back(box);
    truth.push_back(objects[i].id);
  }
  for (int n = poisson(clutter, config.clutter_per_frame); n > 0; --n) {
    const double bearing = clutter.uniform(-config.half_field_rad, config.half_field_rad);
    const double depth = clutter.uniform(5.0, config.max_range_m), width = clutter.uniform(0.4, 3.0);
    const auto kind = static_cast<sim::world::traffic::ObjectClass>(clutter.uniform() * kClassCount);
    const double column = -config.focal_px * std::tan(bearing), half = 0.5 * config.focal_px * width / depth;
    const MonoBox box{column - half, column + half, row_of(config, depth, 0.0),
                      row_of(config, depth, sim::world::traffic::traits_of(kind).height), kind};
    if (!in_view(config, box, bearing)) continue;
    if (static_cast<int>(boxes.size()) == config.max_boxes) break;
    boxes.push_back(box);
    truth.push_back(ObjectId{0xffff});
  }
}

}  // namespace ttf::sensors::mono_camera
