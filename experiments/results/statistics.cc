#include "experiments/results/statistics.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace ttf::experiments::results {

void Moments::add(double x) {
  if (!std::isfinite(x)) return;
  ++count_;
  const double off = x - mean_;
  mean_ += off / static_cast<double>(count_);
  squares_ += off * (x - mean_);
}

double Moments::variance() const {
  return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : std::numeric_limits<double>::quiet_NaN();
}

Interval interval_of(const Moments& moments, double confidence) {
  Interval interval{moments.count(), moments.mean()};
  if (moments.count() < 2) return interval;
  const auto samples = static_cast<double>(moments.count());
  const boost::math::students_t distribution(samples - 1.0);
  interval.half_width =
      boost::math::quantile(distribution, 0.5 + 0.5 * confidence) * std::sqrt(moments.variance() / samples);
  return interval;
}

}  // namespace ttf::experiments::results
