// The orientation of the rectangle that returns lie closest to: algorithm 4, closeness criterion, of the article named
// in rectangle_fit.h. Every two degrees over a quarter turn, then around the best of these every 0.22 degrees.
//
// Four candidates are scored at a time, each lane doing what a scalar form would, return by return.
#pragma once

#include <span>

#include "nodes/laser/segmentation.h"

namespace ttf::nodes::laser {

// The candidate angle [rad] with the highest score, the first one of several. The score is the sum of
// 1 / max(d, closest) over the returns, d [m] their distances to the nearer face in view, closest > 0 [m]. At least one
// point, all finite.
double search_orientation(std::span<const PlanePoint> points, double closest);

// Computes the candidates' directions, which the first search would do otherwise.
void prepare_orientation_search();

}  // namespace ttf::nodes::laser
