// What the fusion knows of a sensor beyond its noise: where it is mounted, and what it is systematically wrong by
// (fusion/sensors/systematic.h). As YAML, every key with the default "none":
//
//   mounting: {x: 3.5, y: 0.0, heading: 0.0}      # on the vehicle: [m], and [rad] from its x axis to the sensor's
//   bias: {range: 0.2, bearing: 0.01}             # known: what the sensor says too much, corrected for
//   bias_sigma: {range: 0.1, bearing: 0.005, time: 10 ms}   # what is left, unknown: TrackerConfig::systematic
//
// Errors are of what the sensor measures, in its own axes: of its positions (x, y), or of range, bearing and, where it
// tells it, range rate. A sensor that gives positions which it has from ranges and bearings, as a laser scanner or a
// camera, errs in these: a bias of its bearing moves what is far away further. What is wrong with the mounting is such
// an error, too. A stamp's bias is positive where things are measured later than the stamp says.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "core/ids.h"
#include "core/strict_yaml.h"
#include "fusion/linear/gaussian.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::sensors {

enum class ErrorAxes : unsigned char { kPolar, kCartesian };

struct SystematicErrors {
  ErrorAxes axes = ErrorAxes::kPolar;
  linear::Vector<3> known =
      linear::Vector<3>::Zero();  // of range [m], bearing [rad], range rate [m/s]; or of x, y [m], and nothing
  linear::Vector<4> sigma = linear::Vector<4>::Zero();  // of what is left of these, and of the stamp [s]
};

struct KnownSensor {
  std::string name;
  int line = 0;  // of the file that names it; 0 where none does
  sensors::Mounting mounting{};
  SystematicErrors errors;

  // On the vehicle's origin, along its axes, and right as far as is known: what it says is what the tracker takes.
  bool plain() const;
};

// Reads `mounting`, `bias` and `bias_sigma`. Name and line are the caller's to give.
KnownSensor load_known_sensor(YamlMap& yaml);

// The most biases with a sigma above zero that a tracker carries, those of all sensors together: every track has their
// correlation with its state (fusion/estimators/estimate.h), so that copies of it grow with them.
inline constexpr int kMostBiases = 8;
int count_biases(std::span<const KnownSensor> sensors);
// A finding about `key` where they are more.
void check_biases(std::span<const KnownSensor> sensors, YamlMap& yaml, std::string_view key);

// What sensor `id` said in its own axes becomes what it says in the vehicle's, less what it is known to be wrong by:
// positions and headings whole, of range, bearing and range rate only the bias, for these are seen from where it is.
void place(Observation& observation, SensorId id, const KnownSensor& sensor);

// Of many, by SensorId; of a sensor beyond them nothing is known.
inline const KnownSensor* known(std::span<const KnownSensor> sensors, SensorId id) {
  return index_of(id) < sensors.size() ? &sensors[index_of(id)] : nullptr;
}
// Where it stands [m], in the vehicle's axes.
inline linear::Vector<2> place_of(std::span<const KnownSensor> sensors, SensorId id) {
  const KnownSensor* sensor = known(sensors, id);
  return sensor != nullptr ? sensor->mounting.position : linear::Vector<2>(0.0, 0.0);
}

}  // namespace ttf::fusion::sensors
