// The centre of an object, of which the track follows another point (fusion/tracks/body/anchor.h).
//
// The centre moves with its anchor, and swings about it as the object turns (fusion/tracks/body/turn.h). An error of the size
// shifts the centre by the same amount in every image.
//
// A heading may be lost. The centre of such an object lies half a mean chord behind its silhouette
// (fusion/tracks/body/behind.h). Between a sure heading and a lost one, both ways count with weights (a mixture). So the centre
// never jumps.
#pragma once

#include "fusion/estimators/estimate.h"
#include "fusion/tracks/body/body.h"
#include "fusion/tracks/body/facing.h"

namespace ttf::fusion::tracks::body {

// The estimate of an object's centre, and the direction of its front.
template <int R> struct CentreOf {
  linear::Gaussian<R> estimate;  // the first R components
  Facing facing;
};
using Centre = CentreOf<6>;
using CentrePosition = CentreOf<2>;

// Returns the centre of an object whose anchor has this estimate. `shown` is Body::shown. To first order, its covariance
// contains those of size, heading and turn rate, with all correlations that they bring between position, velocity and
// acceleration. An acceleration that the model does not have stays unknown.
Centre centred(const Anchor& anchor, const Extent& extent, const Heading& axis, const Scalar& shown,
               const estimators::Cartesian& estimate);
inline Centre centred(const Body& body, const estimators::Cartesian& estimate) {
  return centred(body.anchor, body.extent, body.heading, body.shown, estimate);
}
// Returns the position of centred() to the bit, for less work.
CentrePosition centre_position(const Body& body, const estimators::Cartesian& estimate);

// Returns the aspect of the outline from a place [m]. Returns no value if the centre is there.
std::optional<Aspect> aspect_of(const Body& body, const estimators::Cartesian& estimate, const linear::Vector<2>& from);

}  // namespace ttf::fusion::tracks::body
