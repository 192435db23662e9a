#include "evaluation/accuracy/closest_pairs.h"

#include <algorithm>
#include <cmath>

namespace ttf::evaluation::accuracy {

std::vector<TruthPair> closest_pairs(std::span<const PlanePosition> truth, std::span<const PlanePosition> estimates,
                                     double gate_m) {
  struct Candidate {
    double distance;
    TruthPair pair;
  };
  std::vector<Candidate> candidates;
  // Bounds each axis on its own, no tighter than rounding: that excludes nearly all pairs of many objects
  // cheaply.
  const double reach = gate_m * (1.0 + 1e-9);
  for (std::size_t t = 0; t < truth.size(); ++t)
    for (std::size_t e = 0; e < estimates.size(); ++e) {
      const double dx = truth[t].x - estimates[e].x, dy = truth[t].y - estimates[e].y;
      if (std::abs(dx) > reach || std::abs(dy) > reach) continue;
      const double distance = std::hypot(dx, dy);
      if (distance <= gate_m) candidates.push_back({distance, {t, e}});
    }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    return a.pair.truth != b.pair.truth ? a.pair.truth < b.pair.truth : a.pair.estimate < b.pair.estimate;
  });
  std::vector<char> truth_taken(truth.size()), estimate_taken(estimates.size());
  std::vector<TruthPair> pairs;
  for (const Candidate& candidate : candidates) {
    char &t = truth_taken[candidate.pair.truth], &e = estimate_taken[candidate.pair.estimate];
    if (t || e) continue;
    t = e = 1;
    pairs.push_back(candidate.pair);
  }
  return pairs;
}

}  // namespace ttf::evaluation::accuracy
