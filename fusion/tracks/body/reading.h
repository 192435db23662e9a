// The two readings of a rectangle: which of its sides is the length.
//
// A sensor measures a face: its middle, its direction and its length. A truck's rear and a motorbike's side are alike in that. A sensor
// calls it an end of the width s with the axis h. It may be a side of the length s with the axis h + 90 degrees, and the other way round.
// A corner stays a corner. The rectangle is the same in both readings. Only the names of its sides and axes change. Spans, returns and
// distances are the same, too.
//
// So the axis of a body is measured up to a quarter turn. Without the front it is up to half a turn. An observation counts in the
// reading that fits the body better. The body as a whole may be read anew (fusion/tracks/parts/classes.h).
#pragma once

#include <optional>

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/body/body.h"
#include "fusion/tracks/body/turn.h"

namespace ttf::fusion::tracks::body {

// Return the same in the other reading: axes on by a quarter turn, length and width exchanged, end and side exchanged. The front of
// such a heading is unknown.
sensors::Observation read_otherwise(const sensors::Observation& observation);
Anchor read_otherwise(const Anchor& anchor);
Heading read_otherwise(const Heading& heading);

// An object moves along its length. Across, the velocity of its centre has the variance kSlip^2 + (kSlipOfSpeed speed)^2, as it turns and
// as its heading is not quite its course. The values are assumed.
inline constexpr double kSlip = 0.3;  // [m/s]
inline constexpr double kSlipOfSpeed = 0.1;

// Returns the axis of the body's length [rad]: the measured one, or else that of the course.
Direction axis_of(const Body& body, const estimators::Estimator& estimator);

// Returns whether the other reading of an observation fits a body of this axis and extent better: by the innovation of the axis, and
// by those of the sides, which count up to five standard deviations. So a sure axis decides alone, and the sizes decide where it is not
// sure. An observation of no face stands as it is.
bool reads_otherwise(const Direction& axis, const Extent& extent, const sensors::Observation& observation);
// Returns the observation in its other reading, if that fits the body better.
inline std::optional<sensors::Observation> better_reading(const Body& body, const estimators::Estimator& estimator,
                                                          const sensors::Observation& observation) {
  if (!observation.has_heading || !reads_otherwise(axis_of(body, estimator), body.extent, observation))
    return std::nullopt;
  return read_otherwise(observation);
}

}  // namespace ttf::fusion::tracks::body
