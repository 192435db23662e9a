// Matches true objects and estimates one to one at least cost: the pairs with which an image is judged.
//
// With a gate c, the pairs minimise the sum over all pairs of d^2 plus c^2 / 2 for every object and every estimate
// left apart, as GOSPA does with p = 2 and alpha = 2 (set_distance.h). Taking the closest pair first may leave both
// neighbours with a partner out of reach; the least sum does not.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/metrics/point.h"

namespace ttf::fusion::metrics {

struct ObjectPair {
  std::size_t truth = 0, estimate = 0;
};

// Returns pairs no further apart than `gate_m` (> 0) [m], by growing distance; each truth and each estimate is in at
// most one. Pairs of equal distance stand in the order of truth; among equal sums, truths prefer the first estimates,
// in order. Positions that are not finite stay apart. n separated objects take about n log n steps, a group of k within
// reach of each other k^3.
std::vector<ObjectPair> object_pairs(std::span<const Point> truths, std::span<const Point> estimates, double gate_m);

}  // namespace ttf::fusion::metrics
