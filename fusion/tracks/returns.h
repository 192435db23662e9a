// The spread of a radar's returns over an outline, of which the mean of a few has its part.
//
// Returns lie evenly over the azimuths of the visible outline (sim/world/radar.h). So the mean of n of them is the silhouette's
// (fusion/tracks/anchor.h), beside the noise with the covariance C / n. C is that of range, bearing and range rate over the
// outline: of 1.8 m across behind a car, of 4.4 m along beside it. A return of several merged echoes has less, by an unknown
// part.
//
// The outline is that of the track's box. Where its heading is unknown, the box stands at an eighth of a turn to the line of
// sight, which shows both of its sides.
#pragma once

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/mounted.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks {

// A box as a sensor sees it: in the vehicle's axes, from the sensor's place.
struct SeenBox {
  linear::Vector<2> centre = linear::Vector<2>::Zero();  // [m]
  Box box;
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // the centre's, relative to the sensor [m/s]
  double turn_rate = 0.0;                                  // [rad/s]
};
// Returns C. Around the sensor there is no outline, and C is zero.
linear::Matrix<3> spread_of(const SeenBox& outline);

// Returns the observation with C / n added, as one of this track; of one without returns, an equal one.
sensors::Observation with_spread(const sensors::Observation& observation, const Track& track,
                                 const estimators::Estimator& estimator, const sensors::Mounting& mounting);
// The same, of an object that is new.
sensors::Observation with_spread(const sensors::Observation& observation, const Extent& extent);

}  // namespace ttf::fusion::tracks
