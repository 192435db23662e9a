// Observations of any point of an object, referred to the point that its track follows (fusion/tracks/anchor.h).
//
// Mostly the anchor is the very point that was observed. Otherwise the distance of the two follows from size and heading.
// Its error by the size repeats in every list. So it must not be averaged away as noise.
//
// The track carries no correlation of position and size. Instead, along each axis of the object, the less certain of the
// two learns, and the other one stays. With p the variance of the track's position and c that of the distance:
//   p > c   The position learns. The observation counts with an additional variance of max(c, p c / (p - c)). The position
//           then keeps at least the variance c (the bound of a consider state, fusion/tracks/extent.h).
//   p < c   The size learns in the same way. Then p is the variance that repeats.
// So an observation teaches one of the two, and none twice.
//
// The centre moves with its anchor, and swings about it as the object turns. Two sources tell the turn rate, each by its
// certainty: the motion (v x a / v^2), if its model has an acceleration, and the heading (fusion/tracks/heading.h). A
// vehicle heads where its centre moves. So this course counts for the heading.
//
// A heading may be lost. The centre of such an object lies half a mean chord behind its silhouette. Between a sure heading
// and a lost one, both ways count with weights (a mixture). So the centre never jumps.
//
// The anchor moves when it is no longer seen (kListsElsewhere). A silhouette gives way at once to an end, a side or a
// corner. The variance of the distance then becomes part of the position's, once.
#pragma once

#include <optional>

#include "fusion/estimators/estimate.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks {

// So many lists in a row observed the track elsewhere than at its anchor: then the anchor moves.
inline constexpr int kListsElsewhere = 3;
// A silhouette is no fixed place of its object, so that it takes longer to become an anchor.
inline constexpr int kListsBeforeSilhouette = 12;
// Spectral density of the width that a turning object shows [m^2/s]: it wanders by half a metre within a second.
inline constexpr double kTurningSilhouette = 0.25;

// A heading with a standard deviation [rad] up to this one is sure: it alone tells where an object's points are.
inline constexpr double kSureHeading = 0.1;

// An observed point relative to a track's anchor.
struct Distance {
  Anchor to;                                               // the observed point
  linear::Vector<2> between = linear::Vector<2>::Zero();   // from the anchor to the point [m]
  linear::Matrix<2> by_size = linear::Matrix<2>::Zero();   // its derivatives by length and width
  linear::Matrix<2> constant = linear::Matrix<2>::Zero();  // covariance by the sizes, which repeats [m^2]
  linear::Matrix<2> noise = linear::Matrix<2>::Zero();     // covariance by the heading [m^2]
  linear::Vector<2> axis = linear::Vector<2>::UnitX();     // the object's
  linear::Vector<2> velocity = linear::Vector<2>::Zero();  // the anchor's [m/s]
  linear::Vector<2> swing = linear::Vector<2>::Zero();     // the point's velocity relative to the anchor [m/s]
};

// Returns the distance of an observed point from the track's anchor, and no value if they are one point. The mounting is
// the sensor's.
std::optional<Distance> distance_to(const Track& track, const estimators::Estimator& estimator,
                                    const sensors::Observation& observation, const sensors::Mounting& mounting);

// Returns the observation as one of the anchor.
//   expected  with all of its uncertainty, for gates and likelihoods
//   counted   with the variances stated above, for updates; `p` is the covariance of the track's position [m^2]
sensors::Observation expected(const sensors::Observation& observation, const Distance& distance,
                              const sensors::Mounting& mounting);
sensors::Observation counted(const sensors::Observation& observation, const Distance& distance,
                             const sensors::Mounting& mounting, const linear::Matrix<2>& p);

// Corrects the sizes by the position of another point than the anchor; `at` is the anchor's before this observation.
void learn_size(Extent& extent, const sensors::Observation& observation, const Distance& distance,
                const linear::Gaussian<2>& at);

// Returns the anchor of a new track with this first observation.
Anchor first_anchor(const sensors::Observation& observation, const sensors::Mounting& mounting);

// The estimate of an object's centre, and the direction of its front.
template <int R> struct CentreOf {
  linear::Gaussian<R> estimate;  // the first R components
  Facing facing;
};
using Centre = CentreOf<6>;
using CentrePosition = CentreOf<2>;

// Returns the centre of an object whose anchor has this estimate. `shown` is Track::shown. To first order, its covariance
// contains those of size, heading and turn rate, with all correlations that they bring between position, velocity and
// acceleration. An acceleration that the model does not know stays so.
Centre centred(const Anchor& anchor, const Extent& extent, const Heading& axis, const Scalar& shown,
               const estimators::Cartesian& estimate);
inline Centre centred(const Track& track, const estimators::Cartesian& estimate) {
  return centred(track.anchor, track.extent, track.heading, track.shown, estimate);
}
// Returns the position of centred() to the bit, for less work.
CentrePosition centre_position(const Track& track, const estimators::Cartesian& estimate);

}  // namespace ttf::fusion::tracks
