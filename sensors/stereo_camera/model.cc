#include "sensors/stereo_camera/model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/random.h"
#include "sensors/clutter.h"
#include "sensors/shape.h"

namespace ttf::sensors::stereo_camera {
namespace {

std::optional<Seen> see(const ObjectState& state) {
  const auto span = azimuth_span(state);
  if (!span) return std::nullopt;
  Seen seen{0.5 * (span->low + span->high), 0.0, span->high - span->low};
  constexpr int kRays = 16;
  int hits = 0;
  const RayTarget target(state);
  for (int k = 0; k < kRays; ++k) {
    const double azimuth = span->low + (k + 0.5) / kRays * seen.silhouette;
    if (const auto range = target.ray_to(azimuth)) {
      seen.depth += *range * std::cos(azimuth);
      ++hits;
    }
  }
  if (hits == 0) return std::nullopt;
  seen.depth /= hits;
  return seen;
}

// An object is looked for in the field, within the range.
Sight sight_of(const Seen& seen, const CameraConfig& config) {
  Sight sight{seen.bearing, seen.depth / std::cos(seen.bearing), 0.5 * seen.silhouette, true};
  sight.wanted = seen.depth > 0.0 && std::abs(seen.bearing) <= config.half_field_rad &&
                 sight.range <= config.max_range_m && !config.device.blind.hold(seen.bearing);
  return sight;
}

}  // namespace

CameraConfig load_camera(YamlMap& yaml) {
  CameraConfig c;
  c.baseline_m = yaml.number_or("baseline", c.baseline_m, {0.01, 5.0}, "m");
  c.focal_px = yaml.number_or("focal", c.focal_px, {50.0, 20000.0}, "px");
  c.disparity_sigma_px = yaml.number_or("disparity_sigma", c.disparity_sigma_px, {0.0, 20.0}, "px");
  c.bearing_sigma_rad = yaml.number_or("bearing_sigma", c.bearing_sigma_rad, {0.0, 0.5}, "rad");
  c.width_sigma_px = yaml.number_or("width_sigma", c.width_sigma_px, {0.0, 100.0}, "px");
  c.half_field_rad = yaml.number_or("half_field", c.half_field_rad, {0.01, 1.2}, "rad");
  c.max_range_m = yaml.number_or("max_range", c.max_range_m, {1.0, 500.0}, "m");
  c.miss_probability = yaml.number_or("miss_probability", c.miss_probability, {0.0, 1.0});
  c.shadow = yaml.number_or("shadow", c.shadow, {0.0, 1e6});
  c.clutter_per_frame = yaml.number_or("clutter_per_frame", c.clutter_per_frame, {0.0, 10.0});
  c.bearing_bias.fixed = yaml.number_or("bearing_bias", 0.0, {-0.2, 0.2}, "rad");
  c.bearing_bias.sigma = yaml.number_or("bearing_bias_sigma", 0.0, {0.0, 0.2}, "rad");
  c.disparity_bias.fixed = yaml.number_or("disparity_bias", 0.0, {-5.0, 5.0}, "px");
  c.disparity_bias.sigma = yaml.number_or("disparity_bias_sigma", 0.0, {0.0, 5.0}, "px");
  c.device = load_device(yaml);
  if (!c.device.enabled) c.clutter_per_frame = 0.0;
  return c;
}

CameraConfig in_weather(CameraConfig camera, const sim::world::Weather& weather) {
  camera.max_range_m *= weather.camera_range;
  camera.miss_probability = std::min(1.0, camera.miss_probability * weather.camera_misses);
  camera.clutter_per_frame *= weather.camera_clutter;
  return camera;
}

CameraConfig in_drive(CameraConfig config, const DriveKey& key) {
  config.bearing_bias = in_drive(config.bearing_bias, ErrorOf::kBearing, key);
  config.disparity_bias = in_drive(config.disparity_bias, ErrorOf::kDisparity, key);
  config.device.time = in_drive(config.device.time, ErrorOf::kTime, key);
  return config;
}

void measure_camera(const CameraConfig& config, std::span<const ObjectState> objects, const MeasurementKey& key,
                    CameraRoom& room, std::vector<CameraDetection>& detections, std::vector<ObjectId>& truth) {
  detections.clear();
  truth.clear();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto seen = see(objects[i]);
    room.seen[i] = seen.value_or(Seen{});
    room.sights[i] = seen ? sight_of(*seen, config) : Sight{};
  }
  const std::span<const char> hidden =
      room.occlusion.hidden(objects, std::span(room.sights).first(objects.size()), config.shadow);
  RandomStream noise(key.of(Purpose::kSensorNoise));
  RandomStream misses(key.of(Purpose::kSensorMisses));
  RandomStream clutter(key.of(Purpose::kClutter));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    // Every object gets draws, seen or not, so one object's visibility never shifts another's noise.
    const bool missed = misses.uniform() < config.miss_probability;
    const double disparity_noise = noise.normal(), bearing_noise = noise.normal(), width_noise = noise.normal();
    if (missed || !room.sights[i].wanted || hidden[i]) continue;
    if (static_cast<int>(detections.size()) == config.max_detections) continue;
    const Seen& seen = room.seen[i];
    const double width_px = config.focal_px * seen.silhouette / std::cos(seen.bearing);
    const double disparity = config.focal_px * config.baseline_m / seen.depth;
    detections.push_back({seen.bearing + config.bearing_bias.fixed + config.bearing_sigma_rad * bearing_noise,
                          disparity + config.disparity_bias.fixed + config.disparity_sigma_px * disparity_noise,
                          std::max(1.0, width_px + config.width_sigma_px * width_noise)});
    truth.push_back(objects[i].id);
  }
  for (int n = poisson(clutter, config.clutter_per_frame); n > 0; --n) {
    const double bearing = clutter.uniform(-config.half_field_rad, config.half_field_rad);
    const double depth = clutter.uniform(5.0, config.max_range_m);
    const double width_px = clutter.uniform(10.0, 200.0);
    if (static_cast<int>(detections.size()) == config.max_detections) break;
    detections.push_back({bearing, config.focal_px * config.baseline_m / depth, width_px});
    truth.push_back(ObjectId{0xffff});
  }
}

}  // namespace ttf::sensors::stereo_camera
