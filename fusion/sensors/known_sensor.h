// The fusion's knowledge of a sensor beside its noise: its mounting, its field and its systematic
// errors (tests/fusion/sensors/systematic.h). As YAML (fusion/loading/known_sensor.h), where every key defaults to "none":
//
//   mounting: {x: 3.5, y: 0.0, heading: 0.0}      # on the vehicle: [m], and [rad] from its x axis to the sensor's
//   field: {half_angle: 1.05, max_range: 120.0}   # what it sees; absent: nothing is known of that
//   range_rate_span: 60.0                         # [m/s], a radar's range rates are known up to multiples of this
//   bias: {range: 0.2, bearing: 0.01}             # known excess of the measurement, which is subtracted
//   bias_sigma: {range: 0.1, bearing: 0.005, time: 10 ms}   # unknown rest: TrackerConfig::systematic
//
// Errors refer to the sensor's own measurements in its own axes: to (x, y), or to range, bearing and range
// rate. A laser scanner or a camera derives positions from ranges and bearings, so its errors are polar: a
// bearing bias shifts far objects more than near ones. A wrong mounting is such an error, too. A time stamp's
// bias is positive if the measurement happens after its stamp.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "core/ids.h"
#include "fusion/linear/gaussian.h"
#include "fusion/sensors/mounting.h"
#include "fusion/sensors/observation.h"
#include "fusion/sensors/resolution.h"

namespace ttf::fusion::sensors {

enum class ErrorAxes : unsigned char { kPolar, kCartesian };

struct SystematicErrors {
  ErrorAxes axes = ErrorAxes::kPolar;
  linear::Vector<3> known =
      linear::Vector<3>::Zero();  // range [m], bearing [rad], range rate [m/s]; or x, y [m] and unused
  linear::Vector<4> sigma = linear::Vector<4>::Zero();  // for the rest of these, and for the time stamp [s]
};

// From `from` to `to` [rad], counter-clockwise.
struct BlindSector {
  double from = 0.0, to = 0.0;
};

// The part of the plane that a sensor sees, in its own axes. As YAML, where every omitted key sets no bound:
//
//   field: {half_angle: 0.45, min_range: 1.0, max_range: 90.0, shadow: 0.5, blind: [{from: 0.3, to: 0.45}]}
//
// The sensor's own vehicle hides the blind sectors, which lie between two azimuths in the sensor's axes.
//
// Objects hide each other: each hides all behind it, up to the share `shadow` of its own distance. From a mast of
// height h, an object of height t has the shadow t / (h - t). A shadow of 0 hides nothing.
struct Field {
  static constexpr std::size_t kMostBlind = 4;
  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  double half_angle = kUnbounded;                  // [rad], seen to either side of the sensor's axis
  double min_range = 0.0, max_range = kUnbounded;  // [m]
  double shadow = kUnbounded;
  std::array<BlindSector, kMostBlind> blind{};
  std::size_t blind_sectors = 0;

  bool all_around() const { return half_angle >= std::numbers::pi; }
};

struct KnownSensor {
  std::string name;
  int line = 0;  // in the file that names the sensor; 0 without such a file
  sensors::Mounting mounting{};
  SystematicErrors errors;
  std::optional<Field> field;                  // absent: the sensor is taken to see everything
  double range_rate_span = Field::kUnbounded;  // [m/s]: a radar's range rates are known up to multiples of this
  std::optional<Resolution> resolution;        // a radar's that joins returns; absent: all is resolved

  // Returns whether the sensor sits at the vehicle's origin, along its axes and without known biases: the
  // tracker takes its measurements unchanged.
  bool plain() const;
};

// The most biases with a sigma above zero that a tracker carries, for all sensors together. Every track keeps
// their correlation with its state (fusion/estimators/estimate.h), so copies of tracks grow with this number.
inline constexpr int kMostBiases = 8;
int count_biases(std::span<const KnownSensor> sensors);

// Converts an observation of sensor `id` from the sensor's axes to the vehicle's and subtracts the known
// biases. Positions and headings convert completely. Range, bearing and range rate lose only their bias: they
// stay relative to the mounting, which the observation then has.
void place(Observation& observation, SensorId id, const KnownSensor& sensor);

// Takes a placed observation from the vehicle's axes to those in which the vehicle has the place `vehicle`.
void carry(Observation& observation, const Mounting& vehicle);

// Returns sensor `id` of a table by SensorId, or null if the table is shorter.
inline const KnownSensor* known(std::span<const KnownSensor> sensors, SensorId id) {
  return index_of(id) < sensors.size() ? &sensors[index_of(id)] : nullptr;
}

}  // namespace ttf::fusion::sensors
