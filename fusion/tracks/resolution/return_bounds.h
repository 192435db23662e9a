// The bounds of a radar's returns over an outline, and whether a radar resolves two outlines.
#pragma once

#include "fusion/sensors/resolution.h"
#include "fusion/tracks/body/returns.h"

namespace ttf::fusion::tracks::resolution {

// The least and the largest range [m], bearing [rad] and range rate [m/s] over a visible outline. Bearings are in the axes of the
// tracks. They lie about that of the outline's centre. They may exceed half a turn.
struct ReturnBounds {
  linear::Vector<3> low = linear::Vector<3>::Zero(), high = linear::Vector<3>::Zero();
};
ReturnBounds bounds_of(const body::SeenBox& outline);

// Returns whether a return of one outline and a return of the other may be joined to one object.
bool may_join(const ReturnBounds& a, const ReturnBounds& b, const sensors::Resolution& resolution);

}  // namespace ttf::fusion::tracks::resolution
