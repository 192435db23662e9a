#include "fusion/tracks/body/size_evidence.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace ttf::fusion::tracks::body {

SizeEvidence evidence_of(const Extent& extent, const config::Sizes& began) {
  const Extent prior(began);
  const Eigen::Matrix2d before = prior.covariance.inverse(), now = extent.covariance.inverse();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(0.5 * (now - before + (now - before).transpose()));
  const Eigen::Matrix2d turned = axes.eigenvectors();
  // Along each axis, weighted = (now - before) mean + before (mean - prior's). The second part vanishes with the information.
  const Eigen::Vector2d gathered = axes.eigenvalues().cwiseMax(0.0);
  const Eigen::Vector2d weighted = turned.transpose() * (now * extent.size - before * prior.size);
  SizeEvidence evidence;
  evidence.information = turned * gathered.asDiagonal() * turned.transpose();
  evidence.weighted = turned * (gathered.array() > 0.0).select(weighted, 0.0).matrix();
  return evidence;
}

Explained explained(const SizeEvidence& evidence, const config::Sizes& prior) {
  Explained result{Extent(prior)};
  Extent& extent = result.extent;
  const Eigen::Matrix2d before = extent.covariance.inverse();
  const Eigen::Vector2d weighted = before * extent.size + evidence.weighted;
  const double squares = extent.size.dot(before * extent.size), prior_determinant = extent.covariance.determinant();
  const Eigen::Matrix2d after = (before + evidence.information).inverse();
  extent.covariance = 0.5 * (after + after.transpose());
  extent.size = extent.covariance * weighted;
  result.log_likelihood =
      -0.5 * (std::log(prior_determinant / extent.covariance.determinant()) + squares - extent.size.dot(weighted));
  keep_positive(extent);
  return result;
}

}  // namespace ttf::fusion::tracks::body
