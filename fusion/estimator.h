// One object's estimator: a motion model, a filter and the sensors' models, chosen when the tracker is made and unknown
// to all who use it. It has no state: everything is a pure function of the estimate, so that the tracker may copy
// estimates, keep them and go back to them. Nothing allocates.
//
// Laws, tested over every motion model and filter (tests/fusion/estimator_test.cc):
//   1. predict by zero seconds changes nothing; covariances stay symmetric and positive semi-definite.
//   2. position() is the leading part of cartesian().
//   3. An observation is its own best explanation: of the initial estimate it made, its distance is zero.
//   4. The same calls give the same bits, whatever was called in between.
#pragma once

#include <memory>
#include <optional>

#include "fusion/estimate.h"
#include "fusion/observation.h"
#include "fusion/tracker_config.h"

namespace ttf::fusion {

class Estimator {
 public:
  virtual ~Estimator() = default;
  // From a first observation: its position, velocity unknown but for what a radar's range rate says.
  virtual Estimate initial(const Observation& observation) const = 0;
  // By dt >= 0 seconds.
  virtual void predict(Estimate& estimate, double dt) const = 0;
  // nu' S^-1 nu of an observation's innovation, for gating. Nothing where the sensor model has no derivative, an object
  // at the sensor's origin: such an observation cannot be used.
  virtual std::optional<double> distance_squared(const Estimate& estimate, const Observation& observation) const = 0;
  // Takes the observation in; changes nothing where it has no distance.
  virtual void update(Estimate& estimate, const Observation& observation) const = 0;
  virtual Gaussian<2> position(const Estimate& estimate) const = 0;   // (x, y) [m]
  virtual Cartesian cartesian(const Estimate& estimate) const = 0;
  // Where a sensor that is all right but for its systematic errors is expected to see it: position(), unless errors are
  // considered. With the noise of an observation of a position, the distribution its distance is of.
  virtual Gaussian<2> seen_position(const Estimate& estimate, SensorId) const { return position(estimate); }
};

std::shared_ptr<const Estimator> make_estimator(const TrackerConfig& config);

}  // namespace ttf::fusion
