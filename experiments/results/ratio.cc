#include "experiments/results/ratio.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace ttf::experiments::results {

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
  Moments first_before, first_after, second_before, second_after;
  for (const Quadruple& one : values) {
    first_before.add(one.first_before);
    first_after.add(one.first_after);
    second_before.add(one.second_before);
    second_after.add(one.second_after);
  }
  Interval interval{values.size()};
  if (!(std::min({first_before.mean(), first_after.mean(), second_before.mean(), second_after.mean()}) > 0.0))
    return interval;
  Moments influences;  // about a mean of 0
  for (const Quadruple& one : values)
    influences.add((one.first_after / first_after.mean() - one.first_before / first_before.mean()) -
                   (one.second_after / second_after.mean() - one.second_before / second_before.mean()));
  interval.mean = (std::log(first_after.mean()) - std::log(first_before.mean())) -
                  (std::log(second_after.mean()) - std::log(second_before.mean()));
  interval.half_width = interval_of(influences, confidence).half_width;
  return interval;
}

Ratio exponential(const Interval& logarithm) {
  return {logarithm.count, std::exp(logarithm.mean), std::exp(logarithm.low()), std::exp(logarithm.high())};
}

}  // namespace ttf::experiments::results
