// A sensor's place on its vehicle, and its systematic errors: constant through a drive, fixed or drawn once for
// each drive, or both. A draw depends only on the seed, the replication, the sensor and the kind of error:
// compared drives have the same errors.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "core/strict_yaml.h"
#include "core/time.h"
#include "sensors/scene.h"

namespace ttf::sensors {

// A sector of azimuths in the sensor's axes: from `from` to `to` [rad], counter-clockwise.
struct BlindSector {
  double from = 0.0, to = 0.0;
  bool holds(double azimuth) const {
    return std::abs(std::remainder(azimuth - 0.5 * (from + to), 2.0 * std::numbers::pi)) <= 0.5 * (to - from);
  }
};

// The sides of a sensor that its own vehicle hides. Nothing is measured there.
struct BlindSides {
  static constexpr std::size_t kMost = 4;
  std::array<BlindSector, kMost> sectors{};
  std::size_t count = 0;

  bool hold(double azimuth) const {
    for (std::size_t i = 0; i < count; ++i)
      if (sectors[i].holds(azimuth)) return true;
    return false;
  }
};

// In the vehicle's axes: [m], and [rad] from its x axis to the sensor's.
struct Placement {
  double x = 0.0, y = 0.0, heading = 0.0;
};

// Moves the objects from the vehicle's axes to the sensor's.
void see_from(const Placement& placement, std::vector<ObjectState>& objects);

// The error of a whole drive: `fixed` plus a draw from N(0, sigma^2).
struct DriveError {
  double fixed = 0.0, sigma = 0.0;
};

// The properties of every sensor. The stamp errs by `time` [s]: a measurement stamped t was made at t + time. One that is not
// enabled is blind all around, and its lists are empty.
struct Device {
  Placement placement;
  DriveError time;
  BlindSides blind;
  bool enabled = true;
};
// Reads `enabled`, `mounting`, `time_bias`, `time_bias_sigma` and `blind`.
Device load_device(YamlMap& yaml);
// Reads `time_bias` and `time_bias_sigma` [s].
DriveError load_time_error(YamlMap& yaml);

// Values are part of every drive that draws: append only.
enum class ErrorOf : std::uint32_t {
  kTime = 0,
  kRange = 1,
  kBearing = 2,
  kDisparity = 3,
  kRangeRate = 4,
  kPitch = 5,
  kSpeedScale = 8,
  kYawRate = 9
};

struct DriveKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::uint16_t sensor = 0;
};
// One of the sensor's measurements. The draws of its list depend on the key alone.
struct MeasurementKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::uint16_t sensor = 0;
  std::uint32_t sequence = 0;
  StreamKey of(Purpose purpose) const { return {seed, replication, purpose, sensor, sequence}; }
};
// Returns the error in this drive, all of it fixed.
DriveError in_drive(const DriveError& error, ErrorOf what, const DriveKey& key);

// Returns the true instant of a measurement; `true_time` is that of its stamp.
TrueTime measured_at(TrueTime true_time, const Device& device);

}  // namespace ttf::sensors
