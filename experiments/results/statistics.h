// Means and their confidence.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace ttf::experiments::results {

// Computes mean and variance in one pass (Welford: "Note on a method for calculating corrected sums of squares
// and products", Technometrics 4, 1962). Values that are not finite are ignored.
class Moments {
 public:
  void add(double x);
  std::uint64_t count() const { return count_; }
  double mean() const { return count_ > 0 ? mean_ : std::numeric_limits<double>::quiet_NaN(); }
  double variance() const;  // the samples', unbiased; not a number for fewer than two

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0, squares_ = 0.0;
};

// mean +- half_width contains the expectation in a share `confidence` of all such samples, if the mean is
// normally distributed: Student's t. half_width is not a number for fewer than two samples. `confidence` is
// above 0 and below 1.
struct Interval {
  std::uint64_t count = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  double half_width = std::numeric_limits<double>::quiet_NaN();
  // The ends of an interval that is not even about the mean (share.h); otherwise not numbers.
  double low_end = std::numeric_limits<double>::quiet_NaN(), high_end = std::numeric_limits<double>::quiet_NaN();

  bool uneven() const { return !std::isnan(low_end); }
  double low() const { return uneven() ? low_end : mean - half_width; }
  double high() const { return uneven() ? high_end : mean + half_width; }
  bool below(double x) const { return high() < x; }  // for certain
  bool above(double x) const { return low() > x; }
};
Interval interval_of(const Moments& moments, double confidence);

}  // namespace ttf::experiments::results
