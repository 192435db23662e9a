// How probable it is that a track's object exists: integrated probabilistic data association (Musicki, Evans,
// Stankovic: "Integrated probabilistic data association", IEEE TAC 39(6), 1994; jointly of several tracks: Musicki,
// Evans: "Joint integrated probabilistic data association: JIPDA", IEEE TAES 40(3), 2004).
//
// With existence e, detection probability P_D, gate probability P_G, clutter density lambda and the density f of the
// track's observation (fusion/estimators/estimator.h), unnormalised by the gate:
//   prediction over dt   e <- e exp(-dt / survival_seconds);
//   a list               L = 1 - P_D P_G + P_D f / lambda, the second term only of a track with an observation,
//                        e <- L e / (1 - e + L e).
// Joint: an observation weighs P_D e f / (lambda (1 - P_D P_G e)) against track and observation both alone, and of a
// track alone the object exists with probability e (1 - P_D P_G) / (1 - P_D P_G e). With one track and one observation
// both say the same. With e = 1 they are JPDA without existence.
//
// Every list counts, of every sensor: the tracker knows no field of view. Where an object is outside a sensor's, that
// sensor's lists count against it as if they had overlooked it, each with the factor 1 - P_D P_G to the odds; one
// observation by another sensor outweighs many of them as long as clutter is rare. A detection probability is therefore
// that of the lists of all sensors together: about a half, where one of two sensors that are as fast sees the object.
//
// Clutter. Positions: lambda is the configuration's, [1/m^2]. Range, bearing and range rate: what is uniform in the
// plane with density lambda has r lambda to the metre and radian at range r; its range rate is taken as uniform over
// the width that has the standard deviation of velocities of which nothing is known, 2 sqrt(3) initial_velocity_sigma:
//   lambda r / (2 sqrt(3) sigma_v)   [1/(m rad m/s)].
#pragma once

#include <algorithm>
#include <cmath>

#include "fusion/association/joint_association.h"
#include "fusion/config/tracker_config.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::tracks {

inline double clutter_at(const sensors::Observation& observation, const config::TrackerConfig& config) {
  if (observation.kind == sensors::ObservationKind::kPosition) return config.clutter_density;
  constexpr double kNearest = 0.1;  // [m], nearer than any sensor sees
  const double width = 2.0 * std::sqrt(3.0) * config.initial_velocity_sigma;
  return config.clutter_density * std::max(kNearest, observation.z(0)) / width;
}

// P_D f / lambda.
inline double likelihood_ratio(const sensors::Observation& observation, double density,
                               const config::TrackerConfig& config) {
  return config.detection_probability * density / clutter_at(observation, config);
}

inline double seen_in_gate(const config::TrackerConfig& config) {
  return config.detection_probability * config.gate_probability;
}

inline double survived(double existence, double dt, const config::TrackerConfig& config) {
  return existence * std::exp(-dt / config.survival_seconds);
}

// L, ratio being zero where there is no observation.
inline double after_list(double existence, double ratio, const config::TrackerConfig& config) {
  const double likelihood = 1.0 - seen_in_gate(config) + ratio;
  return likelihood * existence / (1.0 - existence + likelihood * existence);
}

// Of pairs in joint events. The smallest number above zero, and a bound, keep all sums finite (joint_association.h).
inline double joint_weight(double existence, double ratio, const config::TrackerConfig& config) {
  constexpr double kLeast = 1e-300;
  const double weight = existence * ratio / (1.0 - seen_in_gate(config) * existence);
  return std::clamp(weight, kLeast, association::JointAssociation::kLargestWeight);
}
inline double exists_unseen(double existence, const config::TrackerConfig& config) {
  return existence * (1.0 - seen_in_gate(config)) / (1.0 - seen_in_gate(config) * existence);
}

}  // namespace ttf::fusion::tracks
