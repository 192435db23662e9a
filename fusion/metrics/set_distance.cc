#include "fusion/metrics/set_distance.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::fusion::metrics {

SetMetric::SetMetric(const CutOff& cut_off) : cut_off_(cut_off) {
  TTF_CHECK(std::isfinite(cut_off.distance_m) && cut_off.distance_m > 0.0, "cut-off {} m", cut_off.distance_m);
  TTF_CHECK(cut_off.order >= 1.0 && cut_off.order <= 64.0, "order {}", cut_off.order);
}

// Computes the usual orders without the rounding of pow().
double SetMetric::power(double base) const {
  if (cut_off_.order == 1.0) return base;
  return cut_off_.order == 2.0 ? base * base : std::pow(base, cut_off_.order);
}

double SetMetric::root(double sum) const {
  if (cut_off_.order == 1.0) return sum;
  return cut_off_.order == 2.0 ? std::sqrt(sum) : std::pow(sum, 1.0 / cut_off_.order);
}

SetDistance SetMetric::between(std::span<const Point> truths, std::span<const Point> estimates) {
  const double c = cut_off_.distance_m;
  pairs_.begin(truths.size(), estimates.size());
  for (const NearPair& pair : near_.find(truths, estimates, c))
    if (pair.distance_m < c) pairs_.offer(pair.row, pair.column, power(pair.distance_m / c));
  pairs_.solve(Best::kLeastCost);

  SetDistance result;
  double localisation = 0.0;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const int j = pairs_.column_of()[i];
    if (j == SparsePairs::kNone) continue;
    localisation += power(distance_m(truths[i], estimates[static_cast<std::size_t>(j)]));
    ++result.pairs;
  }
  const auto counted = [](std::size_t n) { return static_cast<double>(n); };
  const double whole = power(c);
  Gospa& gospa = result.gospa;
  gospa.localisation = localisation;
  gospa.missed = 0.5 * whole * counted(truths.size() - result.pairs);
  gospa.false_estimates = 0.5 * whole * counted(estimates.size() - result.pairs);
  gospa.distance_m = root(gospa.localisation + gospa.missed + gospa.false_estimates);

  const std::size_t fewer = std::min(truths.size(), estimates.size()), more = std::max(truths.size(), estimates.size());
  if (more == 0) return result;
  Ospa& ospa = result.ospa;
  ospa.localisation = (localisation + whole * counted(fewer - result.pairs)) / counted(more);
  ospa.cardinality = whole * counted(more - fewer) / counted(more);
  ospa.distance_m = root(ospa.localisation + ospa.cardinality);
  return result;
}

}  // namespace ttf::fusion::metrics
