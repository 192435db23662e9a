// An estimator combines a motion model, a filter and the sensors' models for one object. The tracker's
// configuration chooses it; its users do not depend on the choice. It has no state: each function depends on the
// estimate alone, so the tracker may copy estimates, keep them and return to them. Estimators never allocate.
//
// Laws, tested over every motion model and filter (tests/fusion/estimators/estimator_test.cc):
//   1. predict by zero seconds changes nothing; covariances stay symmetric and positive semi-definite.
//   2. position() and velocity() are parts of cartesian().
//   3. An observation explains its own initial estimate best: its distance to that estimate is zero.
//   4. The same calls give the same bits, whatever calls came between.
//   5. An update by one explanation of weight 1 equals, to the bit, the update by its observation, or no change without
//      one; the order of explanations changes only the rounding.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimate.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::estimators {

// The fit of an observation to an estimate: nu' S^-1 nu, and the density of N(0, S) at nu. The density is per
// unit of the observation: [1/m^2] for a position, [1/(m rad m/s)] for range, bearing and range rate.
struct Fit {
  double distance_squared = 0.0;
  double density = 0.0;
};

// One of several possible explanations: `observation` belongs to the object, or, if null, the object was not
// observed.
struct Explanation {
  const sensors::Observation* observation = nullptr;
  double weight = 0.0;  // its probability
};

class Estimator {
 public:
  virtual ~Estimator() = default;
  // Starts an estimate from a first observation. The velocity is unknown, except along a radar's line of sight.
  virtual Estimate initial(const sensors::Observation& observation) const = 0;
  // Predicts by dt >= 0 seconds.
  virtual void predict(Estimate& estimate, double dt) const = 0;
  // Returns nu' S^-1 nu of an observation's innovation, for gating. Returns no value for an unusable
  // observation: the sensor model has no derivative, for example for an object at the sensor's origin.
  virtual std::optional<double> distance_squared(const Estimate& estimate,
                                                 const sensors::Observation& observation) const = 0;
  // Returns the same distance and the density. Several motion models use mean and covariance of their mixture.
  virtual std::optional<Fit> fit(const Estimate& estimate, const sensors::Observation& observation) const = 0;
  // Updates by the observation; changes nothing if it has no distance.
  virtual void update(Estimate& estimate, const sensors::Observation& observation) const = 0;
  // Updates by several explanations of which one is true; weights are not negative and have sum 1. The result
  // is mean and covariance of the mixture of the explanations' results,
  //   x = sum w_i x_i,   P = sum w_i (P_i + (x_i - x)(x_i - x)').
  // For a linear filter this is the update of probabilistic data association with its spread-of-innovations
  // term (Bar-Shalom, Fortmann 1988, 6.4). It also holds if every observation has its own gain. Several motion
  // models update mode by mode, each weighted by its probability after the explanation.
  virtual void update(Estimate& estimate, std::span<const Explanation> explanations) const = 0;
  virtual linear::Gaussian<2> position(const Estimate& estimate) const = 0;  // (x, y) [m]
  virtual Cartesian cartesian(const Estimate& estimate) const = 0;
  virtual linear::Vector<2> velocity(const Estimate& estimate) const = 0;  // cartesian()'s, to the bit, for less work
  // Returns the position that a sensor without noise is expected to measure from there: position(), unless systematic
  // errors are considered. With the noise of a position observation added, it is the distribution behind that
  // observation's distance.
  virtual linear::Gaussian<2> seen_position(const Estimate& estimate, SensorId, const sensors::Mounting&) const {
    return position(estimate);
  }
};

// Moves an estimate to another point of its object: shifts the position and adds the covariance of the shift.
void displace(Estimate& estimate, const Displacement& displacement);

std::shared_ptr<const Estimator> make_estimator(const config::TrackerConfig& config);

}  // namespace ttf::fusion::estimators
