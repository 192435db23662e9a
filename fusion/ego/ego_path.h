// The way of the vehicle in the odometry frame, which is fixed to the ground. It begins at the vehicle's pose at the first
// sample. Tracks live in this frame, and each list is placed by the pose at its own instant.
//
//   samples      s0 ------ s1 ------ s2 - - - - ->
//   motion       linear    linear    as in s2
//
// Between two samples, speed and yaw rate are linear, and
//   heading(t) = int yaw_rate,   position(t) = int speed (cos heading, sin heading) + aside (-sin heading, cos heading).
// Aside is the drift of the rear axle (OdometryErrors::slip).
// The first integral is exact. Four-point Gauss-Legendre quadrature takes the second one, with an error of eighth order in the
// angle turned between samples. Beyond the newest sample, speed and yaw rate stay, and the way is an arc. So it was in a gap
// that is longer than OdometryErrors::longest_age: lists that were placed while the odometry had stopped stay in their places.
//
// Laws (tests/fusion/ego/ego_path_test.cc):
//   1. Until the newest sample, the way is final: later samples change nothing there. So lists placed there are placed
//      alike, whenever they come.
//   2. A sample that is not newer than the newest one is refused.
//   3. Nothing allocates after construction.
//
// The pose beyond the newest sample is uncertain, as the vehicle may accelerate and turn (OdometryErrors): after a time d by
//   along^2 = (speed_sigma d)^2 + (acceleration_sigma d^2 / 2)^2,   turn^2 likewise, with the sigmas of that sample.
// This is the whole uncertainty of a pose: the frame is what the odometry says. Its drift over the ground belongs to the
// tracks. The drift by noise is part of their process noise (OdometryErrors::drift_density()). Constant errors move a
// standing object steadily through the frame: tracks follow, and their positions stay right (fusion/tracks/own_axes.h).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/time.h"
#include "fusion/ego/odometry.h"
#include "fusion/sensors/mounting.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::ego {

// The vehicle at an instant.
struct EgoState {
  sensors::Mounting vehicle;    // its place and motion in the odometry frame
  double along_variance = 0.0;  // [m^2], of its place along its x axis
  double turn_variance = 0.0;   // [rad^2], of its heading: it turns about a point so far behind its origin:
  double behind = 0.0;          // [m]
};

class EgoPath {
 public:
  // Remembers so many samples: some seconds, or a whole recording.
  explicit EgoPath(const OdometryErrors& errors, std::size_t remembered = 1024);

  // Takes a sample; returns false if it is not newer than the newest one.
  bool accept(const OdometrySample& sample);
  bool started() const { return count_ > 0; }
  // Returns the newest sample; there must be one. Its known errors are subtracted.
  const OdometrySample& newest() const { return at_index(count_ - 1).sample; }
  // Returns whether the newest sample is too old at `now`, or there is none.
  bool has_stopped(GlobalTime now) const { return !started() || now - newest().at > errors_.longest_age; }
  // Returns the vehicle's state, and no value before the oldest sample that is remembered.
  std::optional<EgoState> at(GlobalTime time) const;
  const OdometryErrors& errors() const { return errors_; }

 private:
  // A sample with the pose at its instant.
  struct Knot {
    OdometrySample sample;
    linear::Vector<2> position = linear::Vector<2>::Zero();
    double heading = 0.0;
  };
  const Knot& at_index(std::size_t i) const { return knots_[(first_ + i) % knots_.size()]; }
  // [m/s], of the rear axle's middle to the left.
  double aside(double speed, double yaw_rate) const { return -errors_.slip * speed * speed * yaw_rate; }
  sensors::Mounting moved_on(const Knot& from, const OdometrySample* next, GlobalTime time) const;

  OdometryErrors errors_;
  std::vector<Knot> knots_;  // a ring, the oldest at first_
  std::size_t first_ = 0, count_ = 0;
};

// Takes a placed observation from the vehicle's axes into the odometry frame, and adds the pose's uncertainty to its noise.
void carry(sensors::Observation& observation, const EgoState& ego);

}  // namespace ttf::fusion::ego
