// One object's estimator: a motion model, a filter and the sensors' models, chosen when the tracker is made and unknown
// to all who use it. It has no state: everything is a pure function of the estimate, so that the tracker may copy
// estimates, keep them and go back to them. Nothing allocates.
//
// Laws, tested over every motion model and filter (tests/fusion/estimators/estimator_test.cc):
//   1. predict by zero seconds changes nothing; covariances stay symmetric and positive semi-definite.
//   2. position() is the leading part of cartesian().
//   3. An observation is its own best explanation: of the initial estimate it made, its distance is zero.
//   4. The same calls give the same bits, whatever was called in between.
//   5. An update by one explanation of weight 1 is the update by its observation, or nothing at all, to the bit; the
//      order of explanations does not matter but for rounding.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimate.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::estimators {

// How well an estimate explains an observation: nu' S^-1 nu, and the density of N(0, S) at nu, per unit of the
// observation: [1/m^2] of a position, [1/(m rad m/s)] of range, bearing and range rate.
struct Fit {
  double distance_squared = 0.0;
  double density = 0.0;
};

// One of several things that may have happened: `observation` is of the object, or, where it is null, none is.
struct Explanation {
  const sensors::Observation* observation = nullptr;
  double weight = 0.0;  // its probability
};

class Estimator {
 public:
  virtual ~Estimator() = default;
  // From a first observation: its position, velocity unknown but for what a radar's range rate says.
  virtual Estimate initial(const sensors::Observation& observation) const = 0;
  // By dt >= 0 seconds.
  virtual void predict(Estimate& estimate, double dt) const = 0;
  // nu' S^-1 nu of an observation's innovation, for gating. Nothing where the sensor model has no derivative, an object
  // at the sensor's origin: such an observation cannot be used.
  virtual std::optional<double> distance_squared(const Estimate& estimate,
                                                 const sensors::Observation& observation) const = 0;
  // The same distance, and the density. Of several motion models, the mixture's mean and covariance.
  virtual std::optional<Fit> fit(const Estimate& estimate, const sensors::Observation& observation) const = 0;
  // Takes the observation in; changes nothing where it has no distance.
  virtual void update(Estimate& estimate, const sensors::Observation& observation) const = 0;
  // Takes in one of several explanations nobody knows which, weights not negative and of sum 1: mean and covariance of
  // the mixture of what each of them makes of the estimate,
  //   x = sum w_i x_i,   P = sum w_i (P_i + (x_i - x)(x_i - x)'),
  // which for a linear filter is the update of probabilistic data association with its spread-of-innovations term
  // (Bar-Shalom, Fortmann 1988, 6.4), and holds as well where every observation has a gain of its own. Of several
  // motion models at a time: mode by mode, each weighed with its probability after the explanation.
  virtual void update(Estimate& estimate, std::span<const Explanation> explanations) const = 0;
  virtual linear::Gaussian<2> position(const Estimate& estimate) const = 0;  // (x, y) [m]
  virtual Cartesian cartesian(const Estimate& estimate) const = 0;
  // Where a sensor that is all right but for its systematic errors is expected to see it: position(), unless errors are
  // considered. With the noise of an observation of a position, the distribution its distance is of.
  virtual linear::Gaussian<2> seen_position(const Estimate& estimate, SensorId) const { return position(estimate); }
};

std::shared_ptr<const Estimator> make_estimator(const config::TrackerConfig& config);

}  // namespace ttf::fusion::estimators
