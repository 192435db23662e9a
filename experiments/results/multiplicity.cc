#include "experiments/results/multiplicity.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace ttf::experiments::results {

double p_value(const Interval& interval, double confidence) {
  if (interval.count < 2 || std::isnan(interval.half_width)) return std::numeric_limits<double>::quiet_NaN();
  if (interval.half_width == 0.0) return interval.mean == 0.0 ? 1.0 : 0.0;
  const boost::math::students_t distribution(static_cast<double>(interval.count) - 1.0);
  const double t =
      std::abs(interval.mean) / interval.half_width * boost::math::quantile(distribution, 0.5 + 0.5 * confidence);
  return 2.0 * boost::math::cdf(boost::math::complement(distribution, t));
}

std::vector<bool> holm(std::span<const double> p_values, double level) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    if (!std::isnan(p_values[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<bool> stays(p_values.size(), false);
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (!(p_values[order[k]] <= level / static_cast<double>(order.size() - k))) break;
    stays[order[k]] = true;
  }
  return stays;
}

Family family_of(std::span<const Interval> differences, double confidence) {
  std::vector<double> p_values;
  for (const Interval& difference : differences) p_values.push_back(p_value(difference, confidence));
  Family family;
  family.stays = holm(p_values, 1.0 - confidence);
  for (const double p : p_values) family.comparisons += !std::isnan(p);
  for (const bool stays : family.stays) family.certain += stays;
  return family;
}

}  // namespace ttf::experiments::results
