// Observations of any point of an object, referred to the point that its track follows (fusion/tracks/body/anchor.h).
//
// Mostly the anchor is the very point that was observed. Otherwise the distance of the two follows from size and heading.
// Its error by the size repeats in every list. So it must not be averaged away as noise.
//
// The track carries no correlation of position and size. Instead, along each axis of the object, the less certain of the
// two is corrected, and the other one stays. With p the variance of the track's position and c that of the distance:
//   p > c   The position is corrected. The observation counts with an additional variance of max(c, p c / (p - c)). The position
//           then keeps at least the variance c (the bound of a consider state, fusion/tracks/body/extent.h).
//   p < c   The size is corrected in the same way. Then p is the variance that repeats.
// So an observation corrects one of the two, and none twice.
//
// A radar's range rate is that of matter. A rigid body's point at the lever l from the anchor has the velocity v + w l', where l' is
// l on by a quarter turn and w is the turn rate. Along the line of sight s, this adds w s l' to the range rate, and the variance of w
// times (s l')^2 to its variance. A silhouette's derivative by the heading is no lever: near end-on a hidden side comes into view,
// and the silhouette runs along the outline by metres a radian.
//
// How the object lies and turns: fusion/tracks/body/turn.h. Where its heading is lost: fusion/tracks/body/behind.h.
#pragma once

#include <optional>

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/body/body.h"

namespace ttf::fusion::tracks::body {

// An observed point relative to a track's anchor.
struct Distance {
  Anchor to;                                               // the observed point
  bool is_vague = false;                                   // it may be another point
  linear::Vector<2> between = linear::Vector<2>::Zero();   // from the anchor to the point [m]
  linear::Matrix<2> by_size = linear::Matrix<2>::Zero();   // its derivatives by length and width
  linear::Matrix<2> constant = linear::Matrix<2>::Zero();  // covariance by the sizes, which repeats [m^2]
  linear::Matrix<2> noise = linear::Matrix<2>::Zero();     // covariance by the heading [m^2]
  linear::Vector<2> axis = linear::Vector<2>::UnitX();     // the object's
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // the anchor's [m/s]
  linear::Vector<2> swing = linear::Vector<2>::Zero();     // matter's velocity there, relative to the anchor [m/s]
  linear::Vector<2> by_rate = linear::Vector<2>::Zero();   // its standard deviation by the turn rate [m/s]
};

// Returns the distance of an observed point from the track's anchor, and no value if they are one point. The mounting is
// the sensor's.
std::optional<Distance> distance_to(const Body& body, const estimators::Estimator& estimator,
                                    const sensors::Observation& observation, const sensors::Mounting& mounting);

// Returns the observation as one of the anchor.
//   expected  with all of its uncertainty, for gates and likelihoods
//   counted   with the variances stated above, for updates; `p` is the covariance of the track's position [m^2]
sensors::Observation expected(const sensors::Observation& observation, const Distance& distance,
                              const sensors::Mounting& mounting);
sensors::Observation counted(const sensors::Observation& observation, const Distance& distance,
                             const sensors::Mounting& mounting, const linear::Matrix<2>& p);

// Corrects the sizes by the position of another point than the anchor; `at` is the anchor's before this observation.
void correct_size(Extent& extent, const sensors::Observation& observation, const Distance& distance,
                  const linear::Gaussian<2>& at);

// Returns the anchor of a new track with this first observation.
Anchor first_anchor(const sensors::Observation& observation, const sensors::Mounting& mounting);

}  // namespace ttf::fusion::tracks::body
