// Where a sensor is on its vehicle, and by what it errs in the same way all through a drive: fixed, or drawn once for
// each drive, or both. A draw depends on the seed, the replication, the sensor and the kind of error alone: drives
// that are compared have the same.
#pragma once

#include <cstdint>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "sim/world/world.h"

namespace ttf::sim::world {

// In the vehicle's axes: [m], and [rad] from its x axis to the sensor's.
struct Placement {
  double x = 0.0, y = 0.0, heading = 0.0;
};

// The objects, given in the vehicle's axes, in the sensor's.
void see_from(const Placement& placement, std::vector<ObjectState>& objects);

// An error of a whole drive: `fixed` and a draw from N(0, sigma^2).
struct DriveError {
  double fixed = 0.0, sigma = 0.0;
};

// What all sensors have. The stamp errs by `time` [s]: what is stamped t was measured at t + time.
struct Device {
  Placement placement;
  DriveError time;
};
// Reads `mounting`, `time_bias` and `time_bias_sigma`.
Device load_device(YamlMap& yaml);

// Values are part of every drive that draws: append only.
enum class ErrorOf : std::uint32_t { kTime = 0, kRange = 1, kBearing = 2, kDisparity = 3 };

struct DriveKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  std::uint16_t sensor = 0;
};
// The error in this drive, all of it fixed.
DriveError in_drive(const DriveError& error, ErrorOf what, const DriveKey& key);

// A drive's instant of measuring, `true_time` being that of the stamp.
TrueTime measured_at(TrueTime true_time, const Device& device);

}  // namespace ttf::sim::world
