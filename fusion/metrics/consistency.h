// NEES and NIS test whether an estimator's covariance is true, by the band of their mean (Bar-Shalom, Li,
// Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, section 5.4.2).
//   NEES: e' P^-1 e, e = truth - estimate; chi-square with as many degrees of freedom as e has dimensions
//   NIS:  nu' S^-1 nu, the innovation and its covariance; chi-square with as many as nu has
// Both use an LDLT solve; P and S are symmetric positive definite.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <limits>

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::metrics {

// Returns the NIS of an innovation and its covariance.
template <int N> double normalised_squared(const linear::Vector<N>& error, const linear::Matrix<N>& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

template <int N> double nees(const linear::Gaussian<N>& estimate, const linear::Vector<N>& truth) {
  return normalised_squared<N>(truth - estimate.x, estimate.p);
}

struct Band {
  double low = 0.0, high = 0.0;
  bool contains(double value) const { return low <= value && value <= high; }
};

// The mean of independent normalised squares of any degrees of freedom: their sum is chi-square with the sum of
// their degrees. Correlated squares, such as the NEES within one drive, make the band too narrow.
class Consistency {
 public:
  // Adds a square. A negative one, or one that is not a number, comes from an invalid covariance. It makes the
  // mean not a number for good: a diverged estimator is never consistent.
  void add(double squared, int degrees);

  std::uint64_t samples() const { return samples_; }
  std::uint64_t degrees() const { return degrees_; }
  // The following values are not a number without samples.
  double mean() const { return samples_ == 0 ? kNothing : sum_ / static_cast<double>(samples_); }
  double expected() const {
    return samples_ == 0 ? kNothing : static_cast<double>(degrees_) / static_cast<double>(samples_);
  }
  // Returns the mean over degrees of freedom: 1 for a consistent estimator, of whatever dimensions.
  double per_degree() const { return samples_ == 0 ? kNothing : sum_ / static_cast<double>(degrees_); }
  // Returns the band of the mean; it lies below and above with probability `tail` each, in (0, 0.5), by default
  // 95 % inside.
  Band band(double tail = 0.025) const;
  bool consistent(double tail = 0.025) const { return band(tail).contains(mean()); }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

  double sum_ = 0.0;
  std::uint64_t samples_ = 0, degrees_ = 0;
};

}  // namespace ttf::fusion::metrics
