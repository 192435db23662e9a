// The visible face of an object's box, the gap to it, and the errors of an image's box.
//
// The box stands in the plane, in the sensor vehicle's axes (ISO 8855); the view is from their origin.
//   visible face   of the faces turned to the origin, two at most, the one whose middle is nearest to it; of equal ones
//                  the rear or the front. For an origin within the box, of all four.
//   gap            the range from the origin to the box along the line of sight to its centre; 0 within the box
// An image's face is that of its own box which points most nearly as the true visible face does. So a box turned round
// by mistake errs in its heading, not by a length in its face.
#pragma once

#include <cstdint>

#include "fusion/metrics/point.h"

namespace ttf::evaluation::accuracy {

struct Box {
  double x = 0.0, y = 0.0;           // centre [m]
  double heading = 0.0;              // [rad], from x to y
  double length = 0.0, width = 0.0;  // along and across the heading [m]
};

enum class Face : std::uint8_t { kRear, kFront, kRight, kLeft };

Face visible_face(const Box& box);
fusion::metrics::Point middle_of(const Box& box, Face face);
double gap_m(const Box& box);

struct BoxError {
  double face_m = 0.0;       // distance of the two middles of the visible face, >= 0
  double gap_m = 0.0;        // estimate minus truth, like the rest
  double heading_rad = 0.0;  // in -pi..pi
  double length_m = 0.0, width_m = 0.0;
};

BoxError error_of(const Box& estimate, const Box& truth);

}  // namespace ttf::evaluation::accuracy
