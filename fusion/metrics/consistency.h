// Does an estimator's covariance tell the truth? NEES and NIS, and the band that their mean lies in if it does
// (Bar-Shalom, Li, Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, section 5.4.2).
//   NEES: e' P^-1 e, e = truth - estimate; chi-square of as many degrees of freedom as e has dimensions
//   NIS:  nu' S^-1 nu, the innovation and its covariance; chi-square of as many as nu has
// Both by an LDLT solve; P and S symmetric positive definite.
#pragma once

#include <Eigen/Cholesky>
#include <cstdint>
#include <limits>

#include "fusion/linear/gaussian.h"

namespace ttf::fusion::metrics {

// Of an innovation and its covariance, the NIS.
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

// Mean of independent normalised squares, of the same or of different degrees of freedom: their sum is chi-square of
// the sum of their degrees. Where they are not independent (the steps of one run are correlated, as NEES) the band is
// too narrow.
class Consistency {
 public:
  // A square that is negative or not a number, as of a covariance that is none, makes the mean not a number for good:
  // whoever diverges is never consistent.
  void add(double squared, int degrees);

  std::uint64_t samples() const { return samples_; }
  std::uint64_t degrees() const { return degrees_; }
  // What follows is not a number without samples.
  double mean() const { return samples_ == 0 ? kNothing : sum_ / static_cast<double>(samples_); }
  double expected() const {
    return samples_ == 0 ? kNothing : static_cast<double>(degrees_) / static_cast<double>(samples_);
  }
  // The mean lies below, and above, with probability `tail` each, in (0, 0.5): 95 % inside unless told.
  Band band(double tail = 0.025) const;
  bool consistent(double tail = 0.025) const { return band(tail).contains(mean()); }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

  double sum_ = 0.0;
  std::uint64_t samples_ = 0, degrees_ = 0;
};

}  // namespace ttf::fusion::metrics
