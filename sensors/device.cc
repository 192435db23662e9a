#include "sensors/device.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace ttf::sensors {

void see_from(const Placement& placement, std::vector<ObjectState>& objects) {
  if (placement.x == 0.0 && placement.y == 0.0 && placement.heading == 0.0) return;
  const double c = std::cos(placement.heading), s = std::sin(placement.heading);
  for (ObjectState& object : objects) {
    const double x = object.x - placement.x, y = object.y - placement.y;
    object.x = c * x + s * y;
    object.y = -s * x + c * y;
    object.heading -= placement.heading;
  }
}

Device load_device(YamlMap& yaml) {
  Device device;
  device.enabled = yaml.boolean_or("enabled", true);
  if (auto mounting = yaml.map_if("mounting")) {
    device.placement.x = mounting->number_or("x", 0.0, {-50.0, 50.0}, "m");
    device.placement.y = mounting->number_or("y", 0.0, {-50.0, 50.0}, "m");
    device.placement.heading = mounting->number_or("heading", 0.0, {-7.0, 7.0}, "rad");
    mounting->finish();
  }
  device.time = load_time_error(yaml);
  for (YamlMap& map : yaml.maps_if("blind")) {
    const double from = map.number("from", {-7.0, 7.0}, "rad"), to = map.number("to", {-7.0, 7.0}, "rad");
    if (to <= from || to - from > 2.0 * std::numbers::pi) map.fail("to", "must be above `from`, by at most a turn");
    map.finish();
    if (device.blind.count < BlindSides::kMost)
      device.blind.sectors[device.blind.count++] = {from, to};
    else
      yaml.fail("blind", fmt::format("must have at most {} sectors", BlindSides::kMost));
  }
  if (!device.enabled) {
    device.blind = {.count = 1};
    device.blind.sectors[0] = {-std::numbers::pi, std::numbers::pi};
  }
  return device;
}

DriveError load_time_error(YamlMap& yaml) {
  constexpr Duration kMost = Duration::milliseconds(1000);
  const double fixed = yaml.duration_or("time_bias", Duration{}, {-kMost, kMost}).seconds();
  return {fixed, yaml.duration_or("time_bias_sigma", Duration{}, {Duration{}, kMost}).seconds()};
}

DriveError in_drive(const DriveError& error, ErrorOf what, const DriveKey& key) {
  if (error.sigma == 0.0) return error;
  RandomStream stream({key.seed, key.replication, Purpose::kSensorBias, key.sensor, static_cast<std::uint32_t>(what)});
  return {error.fixed + error.sigma * stream.normal(), 0.0};
}

TrueTime measured_at(TrueTime true_time, const Device& device) {
  return true_time + Duration{std::llround(1e9 * device.time.fixed)};
}

}  // namespace ttf::sensors
