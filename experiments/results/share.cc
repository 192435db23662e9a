#include "experiments/results/share.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace ttf::experiments::results {
namespace {

Interval between(const Moments& moments, double low, double high) {
  const double mean = moments.mean();
  return {moments.count(), mean, std::max(mean - low, high - mean), low, high};
}

}  // namespace

Interval share_of(const Moments& events, double confidence) {
  if (events.count() == 0) return {};
  const auto n = static_cast<double>(events.count());
  const double z = boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * confidence), p = events.mean();
  const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / (1.0 + z * z / n);
  // Without rounding the interval reaches both 0 and 1 exactly.
  return between(events, p == 0.0 ? 0.0 : middle - half, p == 1.0 ? 1.0 : middle + half);
}

Interval difference_of_shares(const Moments& differences, double confidence) {
  if (differences.count() < 2) return {differences.count(), differences.mean()};
  const auto n = static_cast<double>(differences.count());
  const double sum = n * differences.mean();
  const double apart = std::round((n - 1.0) * differences.variance() + sum * differences.mean());
  const double more = (0.5 * (apart + sum) + 1.0) / (n + 2.0), less = (0.5 * (apart - sum) + 1.0) / (n + 2.0);
  const double middle = more - less;
  const double half = boost::math::quantile(boost::math::students_t(n - 1.0), 0.5 + 0.5 * confidence) *
                      std::sqrt((more + less - middle * middle) / (n + 2.0));
  return between(differences, std::max(-1.0, middle - half), std::min(1.0, middle + half));
}

}  // namespace ttf::experiments::results
