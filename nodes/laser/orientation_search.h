// Searches the orientation of the rectangle that the returns lie closest to: algorithm 4, closeness criterion, of the
// article in rectangle_fit.h. Tries every two degrees over a quarter turn, then every 0.22 degrees around the best one.
//
// Scores four candidates at a time; each lane computes what a scalar form would, return by return.
#pragma once

#include <span>

#include "nodes/laser/segmentation.h"

namespace ttf::nodes::laser {

// Returns the candidate angle [rad] with the highest score, the first of equal ones. The score is the sum of
// 1 / max(d, closest) over the returns. Here d [m] is the distance to the nearer face in view, and
// closest > 0 [m]. Expects at least one point, and finite values.
double search_orientation(std::span<const PlanePoint> points, double closest);

// Computes the candidates' directions now; otherwise the first search would.
void prepare_orientation_search();

}  // namespace ttf::nodes::laser
