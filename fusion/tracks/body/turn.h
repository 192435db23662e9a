// How an object lies and turns: the direction of its length, how sure that is, and its turn rate.
//
// Two sources tell the turn rate, each by its certainty: the motion (v x a / v^2), if its model has an acceleration, and the
// heading (fusion/tracks/body/heading.h). A vehicle heads where its centre moves. The centre moves with its anchor, and
// swings about it as the object turns. So the course of the centre counts for the heading.
//
// A heading may be lost. Between a sure heading and a lost one, both ways count with weights (a mixture). So the centre never
// jumps.
#pragma once

#include <algorithm>

#include "fusion/estimators/estimate.h"
#include "fusion/tracks/body/anchor.h"
#include "fusion/tracks/body/extent.h"
#include "fusion/tracks/body/facing.h"

namespace ttf::fusion::tracks::body {

// A heading with a standard deviation [rad] up to this one is sure: it alone tells where an object's points are.
inline constexpr double kSureHeading = 0.1;

// A heading with a standard deviation [rad] below the first is sure, and beyond the second it is lost. Behind a silhouette
// that is earlier: there the shown width says more. Between them the weight falls smoothly.
struct Sureness {
  double sure, lost;
};
inline constexpr Sureness kBehindSilhouette{kSureHeading, 0.35}, kOfSides{0.5, 1.0};

// The direction of an object's length [rad].
struct Direction {
  double heading = 0.0, sigma = 0.0;
  // Returns how much the direction counts beside what is known without it.
  double weight(const Sureness& limits) const {
    const double t = std::clamp((limits.lost - sigma) / (limits.lost - limits.sure), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
  }
};

// Returns the direction in the sense of the measured axis, if that is known.
inline Direction direction_of(const Scalar& axis, const Facing& facing) {
  return {axis.known ? nearest_half_turn(facing.heading, axis.value) : facing.heading, facing.sigma};
}

// Returns the unit vector from one point to another.
inline linear::Vector<2> sight_to(const linear::Vector<2>& point, const linear::Vector<2>& from) {
  const linear::Vector<2> sight = point - from;
  const double range = sight.norm();
  if (!(range > 0.0)) return linear::Vector<2>::UnitX();
  return sight / range;
}

// Turned by a quarter to the left: the velocity of a point at `a` that turns about the origin with 1 rad/s.
inline linear::Vector<2> quarter_on(const linear::Vector<2>& a) { return {-a.y(), a.x()}; }

// The turn rate [rad/s]. It is the motion's with the weight 1 - own, and the heading's with the weight `own`.
struct Turn {
  double rate = 0.0, variance = 0.0;  // the variance is the heading's part
  double own = 1.0;
  linear::Vector<4> by = linear::Vector<4>::Zero();  // derivatives by velocity and acceleration
};
Turn turn_of(const estimators::Cartesian& estimate, const Heading& axis);

// Returns the direction of the object's front, by the course of its centre; the estimate is the anchor's.
Facing facing_at_centre(const Anchor& anchor, const Extent& extent, const Heading& axis,
                        const estimators::Cartesian& estimate, const Turn& turn);

}  // namespace ttf::fusion::tracks::body
