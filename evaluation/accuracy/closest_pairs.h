// Matches estimates and true objects one to one, the closest pair first.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ttf::evaluation::accuracy {

struct PlanePosition {
  double x = 0.0, y = 0.0;  // [m]
};

struct PlaneEstimate {
  double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;  // [m], [m/s]
};

struct TruthPair {
  std::size_t truth = 0, estimate = 0;
};

// The largest distance [m] between an image's object and a true object that may be matched.
inline constexpr double kGate_m = 4.0;

// Returns pairs no further apart than `gate_m` [m], by growing distance; each truth and each estimate is in at
// most one. Pairs of equal distance are taken in the order of truth, then estimate. It takes about n log n steps. Pairs
// within the gate count as positions.
std::vector<TruthPair> closest_pairs(std::span<const PlanePosition> truth, std::span<const PlanePosition> estimates,
                                     double gate_m);

}  // namespace ttf::evaluation::accuracy
