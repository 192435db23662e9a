#include "experiments/results/ratio.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace ttf::experiments::results {
namespace {

// Returns no number unless all four are above 0.
double log_of_ratios(const Quadruple& of) {
  if (!(of.first_before > 0.0) || !(of.first_after > 0.0) || !(of.second_before > 0.0) || !(of.second_after > 0.0))
    return std::numeric_limits<double>::quiet_NaN();
  return (std::log(of.first_after) - std::log(of.first_before)) -
         (std::log(of.second_after) - std::log(of.second_before));
}

}  // namespace

Ratio ratio_of(std::span<const std::pair<double, double>> pairs, double confidence) {
  Ratio ratio{pairs.size()};
  Moments x, y;
  for (const auto& [one, other] : pairs) {
    x.add(one);
    y.add(other);
  }
  if (!(x.mean() > 0.0) || !(y.mean() > 0.0)) return ratio;
  ratio.value = x.mean() / y.mean();
  if (pairs.size() < 2) return ratio;
  const auto samples = static_cast<double>(pairs.size());
  double products = 0.0;
  for (const auto& [one, other] : pairs) products += (one - x.mean()) * (other - y.mean());
  const double t = boost::math::quantile(boost::math::students_t(samples - 1.0), 0.5 + 0.5 * confidence);
  const double squared = t * t / samples;
  // (x - r y)^2 = t^2 variance(x - r y) is a r^2 - 2 b r + c = 0.
  const double a = y.mean() * y.mean() - squared * y.variance();
  const double b = x.mean() * y.mean() - squared * products / (samples - 1.0);
  const double c = x.mean() * x.mean() - squared * x.variance();
  if (!(a > 0.0)) return ratio;
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  ratio.low = std::max(0.0, (b - root) / a);
  ratio.high = (b + root) / a;
  return ratio;
}

Interval difference_of_differences(std::span<const Quadruple> values, double confidence) {
  Moments moments;
  for (const Quadruple& one : values)
    moments.add((one.first_after - one.first_before) - (one.second_after - one.second_before));
  return interval_of(moments, confidence);
}

Interval log_ratio_of_ratios(std::span<const Quadruple> values, double confidence) {
  Interval interval{values.size()};
  Quadruple sums;
  for (const Quadruple& one : values) {
    sums.first_before += one.first_before;
    sums.first_after += one.first_after;
    sums.second_before += one.second_before;
    sums.second_after += one.second_after;
  }
  interval.mean = log_of_ratios(sums);
  Moments without_one;
  for (const Quadruple& one : values) {
    const double logarithm =
        log_of_ratios({sums.first_before - one.first_before, sums.first_after - one.first_after,
                       sums.second_before - one.second_before, sums.second_after - one.second_after});
    if (std::isnan(logarithm)) return interval;
    without_one.add(logarithm);
  }
  interval.half_width = (static_cast<double>(values.size()) - 1.0) * interval_of(without_one, confidence).half_width;
  return interval;
}

Ratio exponential(const Interval& logarithm) {
  return {logarithm.count, std::exp(logarithm.mean), std::exp(logarithm.low()), std::exp(logarithm.high())};
}

}  // namespace ttf::experiments::results
