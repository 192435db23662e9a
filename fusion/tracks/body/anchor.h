// The anchor of a track: the point of its object whose motion the track estimates, the one that sensors see.
//
// A car seen from behind shows its rear. Its length is unknown, and is the same in every list. So a track follows the
// middle of the rear, whose position is measured. It derives the centre for the image (fusion/tracks/body/distance.h). An error
// of the size then shifts the centre by the same amount in every image. It is never taken for new noise.
//
// With centre c, heading unit vector u, unit vector n to the left, length L and width W:
//   end, side, corner   c + a L / 2 u + b W / 2 n. Here a is 1 for the front and -1 for the rear; b is 1 for the left side
//                       and -1 for the right one. The other one is 0.
//   silhouette          As seen from q, the mean range of the visible outline over its span, in the span's middle. A side
//                       of length w has the distance d from q, and its ends have the ranges r1 and r2. It contributes
//                       d ln((r1 + r2 + w) / (r1 + r2 - w)), the integral of the range over its azimuths.
//
// All functions return derivatives by length, width and heading, in this order.
#pragma once

#include <optional>

#include "core/ids.h"
#include "fusion/linear/gaussian.h"
#include "fusion/sensors/observation.h"

namespace ttf::fusion::tracks::body {

struct Anchor {
  sensors::SeenPoint point = sensors::SeenPoint::kCentre;
  signed char along = 0, across = 0;                   // a and b above; 0 for the centre and for a silhouette
  SensorId sensor = kNoSensor;                         // silhouette: whose; on a moving vehicle q is its newest place
  linear::Vector<2> from = linear::Vector<2>::Zero();  // silhouette: the sensor's place q [m], in the tracks' axes
  // A sensor's silhouettes are one point, also while its vehicle moves.
  bool operator==(const Anchor& other) const {
    return point == other.point && along == other.along && across == other.across &&
           (from == other.from || (sensor == other.sensor && sensor != kNoSensor));
  }
};

// Returns the same anchor in axes that are turned by half a turn.
inline Anchor opposite(Anchor anchor) {
  anchor.along = static_cast<signed char>(-anchor.along);
  anchor.across = static_cast<signed char>(-anchor.across);
  return anchor;
}

// Length and width [m] and heading [rad] of an object.
struct Box {
  linear::Vector<2> size = linear::Vector<2>::Zero();
  double heading = 0.0;
};

// A point [m] and its derivatives by length, width and heading.
struct Located {
  linear::Vector<2> at = linear::Vector<2>::Zero();
  linear::Matrix<2, 3> by_box = linear::Matrix<2, 3>::Zero();
};

// Returns the anchor of an observation of an object at `centre`, from a sensor at `from`: which end or side is the near
// one.
Anchor anchor_of(sensors::SeenPoint point, const linear::Vector<2>& centre, double heading,
                 const linear::Vector<2>& from);
// The same from the heading's unit vector, which only ends, sides and corners need.
Anchor anchor_of(sensors::SeenPoint point, const linear::Vector<2>& centre, const linear::Vector<2>& axis,
                 const linear::Vector<2>& from);

// Returns the corner at `at` where a face ends on its right or left, as seen from a place (SeenPoint); `into_face` is the direction
// across the face [rad]. Returns no value if another corner of this axis would end the outline: a face beside it is seen too flatly.
std::optional<Anchor> outermost_of(sensors::SeenPoint point, double into_face, const linear::Vector<2>& axis,
                                   const linear::Vector<2>& at, const linear::Vector<2>& from);

// Returns the centre of an object whose anchor is at `position`. Returns no value for a silhouette that surrounds its
// sensor.
std::optional<Located> centre_of(const Anchor& anchor, const linear::Vector<2>& position, const Box& box);

// Returns where an object whose anchor is at `position` has the point `other`. Returns no value as centre_of() does.
std::optional<Located> point_of(const Anchor& other, const Anchor& anchor, const linear::Vector<2>& position,
                                const Box& box);

// The silhouette of an object at `centre`, seen from the origin: the point [m], and the span [rad]. Returns no value if
// the outline surrounds the origin.
struct Silhouette {
  Located point;
  double span = 0.0;
  linear::Vector<3> span_by_box = linear::Vector<3>::Zero();
};
std::optional<Silhouette> silhouette_of(const linear::Vector<2>& centre, const Box& box);

}  // namespace ttf::fusion::tracks::body
