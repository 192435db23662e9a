// The body of a track's object: a point of it with its motion, how it lies, and its size. Filters of their own estimate
// heading and extent beside the motion (fusion/estimators/estimator.h).
#pragma once

#include "fusion/estimators/estimate.h"
#include "fusion/tracks/body/anchor.h"
#include "fusion/tracks/body/extent.h"
#include "fusion/tracks/body/heading.h"

namespace ttf::fusion::tracks::body {

// Members are in the order of their use.
struct Body {
  Heading heading;  // the front's direction
  Scalar shown;     // [m], width of the silhouette as cameras see it: tells an unknown heading's depth
  Extent extent;
  Anchor anchor;                  // in the axes of `heading`
  estimators::Estimate estimate;  // the anchor's
};

// Spectral density of the width that a turning object shows [m^2/s]: it wanders by half a metre within a second.
inline constexpr double kTurningSilhouette = 0.25;

}  // namespace ttf::fusion::tracks::body
