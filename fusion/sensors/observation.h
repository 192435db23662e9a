// Observations: one per object, and the list of all observations of one instant.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/sensors/mounting.h"

namespace ttf::fusion::sensors {

// Observations are in the sensor's axes until they are placed (fusion/sensors/known_sensor.h). A placed
// position is in the axes of the tracks (ISO 8855): those of the vehicle, or of the odometry frame if it moves.
enum class ObservationKind : std::uint8_t {
  kPosition,          // z = (x, y) [m]
  kRangeBearingRate,  // z = (range [m], bearing [rad], range rate [m/s])
};

constexpr int dimension_of(ObservationKind kind) { return kind == ObservationKind::kPosition ? 2 : 3; }

// The class of an object: an index into a list of names, which the maker of the observations keeps.
enum class ClassId : std::uint8_t {};
inline constexpr std::size_t kMostClasses = 16;
inline constexpr ClassId kNoClass{0xff};

// Height of a box's centre over the plane of the tracks, and the box's third side [m]. Both are passed through,
// not estimated.
struct ThirdAxis {
  double z = 0.0, height = 0.0;
  bool has_z = false, has_height = false;
};

// The point of an object that a position locates. Ends are the rear and the front; the near one is the one turned to the
// sensor.
enum class SeenPoint : std::uint8_t {
  kCentre,      // the object's centre
  kEnd,         // the middle of the near end
  kSide,        // the middle of the near side
  kCorner,      // where near end and near side meet
  kSilhouette,  // the outline as seen: its mean distance, in the middle of its span
  // A corner: the right or left end of a face, as seen. The outline's other end is hidden. `heading` is the direction into the face,
  // which may be an end or a side; has_heading is false.
  kRightmost,
  kLeftmost,
};
constexpr bool is_outermost(SeenPoint point) { return point == SeenPoint::kRightmost || point == SeenPoint::kLeftmost; }

// Only the first dimension_of(kind) rows and columns of z and r are meaningful; there r is symmetric positive
// definite.
struct Observation {
  ObservationKind kind = ObservationKind::kPosition;
  SeenPoint seen = SeenPoint::kCentre;
  SensorId sensor = kNoSensor;  // gives the errors (fusion/sensors/known_sensor.h); kNoSensor: none known
  Mounting from{};              // the sensor's place in the axes of the tracks, once placed
  Eigen::Vector3d z = Eigen::Vector3d::Zero();
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  double rate_span = std::numeric_limits<double>::infinity();  // [m/s], a range rate is known up to multiples of it
  bool has_heading = false, has_length = false, has_width = false, has_span = false;
  double heading = 0.0, sigma_heading = 0.0;  // [rad], of the object's axis: known up to half a turn
  double length = 0.0, sigma_length = 0.0;    // [m]
  double width = 0.0, sigma_width = 0.0;      // [m], across the object's own axis
  // [rad], the angle of the outline as seen from the sensor: of a rear or a side, as the object is turned.
  double span = 0.0, sigma_span = 0.0;
  ClassId class_id = kNoClass;  // below kMostClasses, or kNoClass
  double score = 0.0;           // not negative: the weight of the class
  ThirdAxis third;
  // A radar's: the mean of so many returns of the visible outline, whose spread r lacks (fusion/tracks/body/returns.h). 0: r has all.
  std::uint8_t returns = 0;
  // In (0, 1]: how surely this is an object of the tracker's kind, and not of the surroundings. A doubtful observation
  // updates tracks, but begins and confirms none.
  double weight = 1.0;
};

// Below this weight an observation is doubtful.
inline constexpr double kSureWeight = 0.5;

// One list of a sensor: all its observations were measured at `measured`.
struct ObservationList {
  MeasurementId id;
  GlobalTime measured{};
  std::span<const Observation> observations;
  // The vehicle's place in the axes of the tracks, and its motion; absent if these are its own axes.
  std::optional<Mounting> vehicle{};
};

}  // namespace ttf::fusion::sensors
