#include "fusion/metrics/object_pairs.h"

#include <algorithm>

#include "core/check.h"
#include "core/ids.h"
#include "fusion/metrics/near_pairs.h"
#include "fusion/metrics/sparse_pairs.h"

namespace ttf::fusion::metrics {

std::vector<ObjectPair> object_pairs(std::span<const Point> truths, std::span<const Point> estimates, double gate_m) {
  TTF_CHECK(std::isfinite(gate_m) && gate_m > 0.0, "gate {} m", gate_m);
  NearPairs near;
  SparsePairs pairs;
  pairs.begin(truths.size(), estimates.size());
  for (const NearPair& pair : near.find(truths, estimates, gate_m)) {
    const double relative = pair.distance_m / gate_m;
    pairs.offer(pair.row, pair.column, relative * relative);
  }
  pairs.solve(Best::kLeastCost);
  std::vector<ObjectPair> taken;
  for (std::size_t truth = 0; truth < truths.size(); ++truth)
    if (const int estimate = pairs.column_of()[truth]; estimate != SparsePairs::kNone)
      taken.push_back({truth, index_of(estimate)});
  const auto apart = [&](const ObjectPair& pair) { return distance_m(truths[pair.truth], estimates[pair.estimate]); };
  std::stable_sort(taken.begin(), taken.end(),
                   [&](const ObjectPair& a, const ObjectPair& b) { return apart(a) < apart(b); });
  return taken;
}

}  // namespace ttf::fusion::metrics
