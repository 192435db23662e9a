// The expected error of an object's estimated length and width, without any draws.
//
// A tracker begins at its prior, of mean m and covariance A, and is corrected by the sensors. The object's size has the mean
// and the covariance S of its draw; a nominal size is certain. So the error e, estimate minus truth, begins with
//   E e e' = S + (m - mean)(m - mean)'.
// A sensor k sees the combination h' (length, width) with the error w + sqrt(c) u_k. Here w is white, of variance v. u_k has
// the variance 1 and is the same in all lists of the sensor. A tracker keeps its variance above the repeating part:
//   p = h' A h,   r = max(v + c, p c / (p - c)),   g = A h / (p + r); with p <= c, nothing is taken in
//   A+ = (I - g h') A (I - g h')' + r g g',   e+ = (I - g h') e + g (w + sqrt(c) u_k)
// (fusion/tracks/body/extent.h; Schmidt 1966). The gains do not depend on measured values. So the moments of (e, u_1, u_2, ...)
// follow a recursion, also for a wrong prior. The code is independent of fusion/tracks, so that tests can compare both.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "fusion/config/tracker_config.h"
#include "sim/world/world.h"

namespace ttf::experiments::sweep {

// The mean and the covariance of length and width [m, m^2].
struct SizeMoments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};
// Returns the moments of sizes as they are drawn, limits included, to 1e-3 of the covariance.
SizeMoments moments_of(const sim::world::SizeConfig& config, const sim::world::Size& nominal);
SizeMoments moments_of(const fusion::config::Sizes& prior);

// A measured combination h' (length, width), with the variances of its errors [m^2]. Sensors have numbers from 0 on.
struct SizeLook {
  std::size_t sensor = 0;
  Eigen::Vector2d h = Eigen::Vector2d::UnitY();
  double white = 0.0, repeating = 0.0;
};

class SizeRecursion {
 public:
  SizeRecursion(const SizeMoments& actual, const SizeMoments& prior);

  void see(const SizeLook& look);
  // The tracker's own covariance, and the expected e e' [m^2].
  const Eigen::Matrix2d& believed() const { return believed_; }
  Eigen::Matrix2d error() const { return moments_.topLeftCorner<2, 2>(); }

 private:
  Eigen::Matrix2d believed_;
  Eigen::MatrixXd moments_;  // E of the products of (e, u_0, u_1, ...), for the sensors so far
};

}  // namespace ttf::experiments::sweep
