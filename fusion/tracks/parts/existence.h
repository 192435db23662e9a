// The probability that a track's object exists: integrated probabilistic data association (Musicki, Evans,
// Stankovic: "Integrated probabilistic data association", IEEE TAC 39(6), 1994; jointly for several tracks:
// Musicki, Evans: "Joint integrated probabilistic data association: JIPDA", IEEE TAES 40(3), 2004).
//
// The symbols are existence e, detection probability P_D, gate probability P_G, clutter density lambda, and the
// density f of the track's observation (fusion/estimators/estimator.h), not normalised by the gate:
//   prediction over dt   e <- e exp(-dt / survival_seconds);
//   a list               L = 1 - P_D P_G + P_D f / lambda, the last term only for a track with an observation,
//                        e <- L e / (1 - e + L e).
// In the joint form a pair weighs P_D e f / (lambda (1 - P_D P_G e)) relative to track and observation both
// alone. An unobserved track's object exists with probability e (1 - P_D P_G) / (1 - P_D P_G e). With one track
// and one observation both forms agree. With e = 1 they are JPDA without existence.
//
// A list says the less of an object, the less its sensor can see of it. With the visibility v (fusion/tracks/parts/visibility.h)
// the detection probability of a list is v P_D. A list of a sensor that cannot see the object leaves the existence as it
// is. An observation counts with at least kVisibleAtAHit all the same: the edges of fields are assumptions. A sensor
// without a known field sees everything. Then each of its lists without an observation multiplies the odds by 1 - P_D P_G.
//
// For positions, the clutter density lambda is the configuration's, [1/m^2]. For range, bearing and range rate,
// a uniform density lambda in the plane is r lambda per metre and radian at range r. The range rate is assumed
// uniform over the width 2 sqrt(3) initial_velocity_sigma, which gives the standard deviation of an unknown
// velocity:
//   lambda r / (2 sqrt(3) sigma_v)   [1/(m rad m/s)].
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "fusion/association/joint_association.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::tracks::parts {

inline double clutter_at(const sensors::Observation& observation, const config::TrackerConfig& config) {
  if (observation.kind == sensors::ObservationKind::kPosition) return config.clutter_density;
  constexpr double kNearest = 0.1;  // [m], below the shortest range of any sensor
  const double width = 2.0 * std::sqrt(3.0) * config.initial_velocity_sigma;
  return config.clutter_density * std::max(kNearest, observation.z(0)) / width;
}

inline constexpr double kVisibleAtAHit = 0.05;

// Returns v w P_D f / lambda. Among observations of weight w, clutter is 1 / w times denser.
inline double likelihood_ratio(const sensors::Observation& observation, double density,
                               const config::TrackerConfig& config, double visible = 1.0) {
  const double detected = std::max(visible, kVisibleAtAHit) * config.detection_probability;
  return detected * density / clutter_at(observation, config) * observation.weight;
}

// Returns v P_D P_G.
inline double seen_in_gate(const config::TrackerConfig& config, double visible = 1.0) {
  return visible * config.detection_probability * config.gate_probability;
}

inline double survived(double existence, double dt, const config::TrackerConfig& config) {
  return existence * std::exp(-dt / config.survival_seconds);
}

// Returns the existence after a list; ratio is zero without an observation.
inline double after_list(double existence, double ratio, const config::TrackerConfig& config, double visible = 1.0) {
  const double likelihood = 1.0 - seen_in_gate(config, visible) + ratio;
  return likelihood * existence / (1.0 - existence + likelihood * existence);
}

// The same by the track's observation and its fit before the update; null without one.
inline double after_list(double existence, const sensors::Observation* observation,
                         const std::optional<estimators::Fit>& fit, const config::TrackerConfig& config,
                         double visible) {
  const double ratio = observation && fit ? likelihood_ratio(*observation, fit->density, config, visible) : 0.0;
  return after_list(existence, ratio, config, visible);
}

// Returns the weight of a pair in joint events. The bounds keep all sums finite (joint_association.h).
inline double joint_weight(double existence, double ratio, const config::TrackerConfig& config, double visible = 1.0) {
  constexpr double kLeast = 1e-300;
  const double weight = existence * ratio / (1.0 - seen_in_gate(config, visible) * existence);
  return std::clamp(weight, kLeast, association::JointAssociation::kLargestWeight);
}
inline double exists_unseen(double existence, const config::TrackerConfig& config, double visible = 1.0) {
  const double seen = seen_in_gate(config, visible);
  return existence * (1.0 - seen) / (1.0 - seen * existence);
}

}  // namespace ttf::fusion::tracks::parts
