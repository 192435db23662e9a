// What a sensor says about one object, and all it says at one instant.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::fusion::sensors {

// In the sensor's axes until it is placed (fusion/sensors/known_sensor.h); then a position is in the sensor car's frame
// (ISO 8855).
enum class ObservationKind : std::uint8_t {
  kPosition,          // z = (x, y) [m]
  kRangeBearingRate,  // z = (range [m], bearing [rad], range rate [m/s])
};

constexpr int dimension_of(ObservationKind kind) { return kind == ObservationKind::kPosition ? 2 : 3; }

// What an object is taken for: a number in a list of names that whoever makes observations keeps.
enum class ClassId : std::uint8_t {};
inline constexpr std::size_t kMostClasses = 16;
inline constexpr ClassId kNoClass{0xff};

// Height of a box's centre over the plane of the tracks, and its third side [m]: passed through, not estimated.
struct ThirdAxis {
  double z = 0.0, height = 0.0;
  bool has_z = false, has_height = false;
};

// Only the first dimension_of(kind) rows and columns of z and r are meaningful; r is symmetric positive definite there.
struct Observation {
  ObservationKind kind = ObservationKind::kPosition;
  SensorId sensor = kNoSensor;  // with whose place and errors it is seen (fusion/sensors/known_sensor.h): nobody's
  Eigen::Vector3d z = Eigen::Vector3d::Zero();
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  bool has_heading = false, has_length = false, has_width = false, has_span = false;
  double heading = 0.0, sigma_heading = 0.0;  // [rad], of the object's axis: known up to half a turn
  double length = 0.0, sigma_length = 0.0;    // [m]
  double width = 0.0, sigma_width = 0.0;      // [m], the object's own, across its axis
  // [rad], the angle the outline subtends at the sensor: a rear's or a side's, as the object happens to be turned.
  double span = 0.0, sigma_span = 0.0;
  ClassId class_id = kNoClass;  // below kMostClasses, or that
  double score = 0.0;           // not negative: how much the class counts
  ThirdAxis third;
};

// One list of a sensor: everything in it was measured at `measured`.
struct Scan {
  MeasurementId id;
  GlobalTime measured{};
  std::span<const Observation> observations;
};

}  // namespace ttf::fusion::sensors
