// Products of matrices whose sizes are known at run time. Eigen's own expressions compile its blocked product anew for each kind
// of factor. So they stand here once.
#pragma once

#include <Eigen/Core>

namespace ttf::experiments::cost {

// Returns a b.
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
// Returns a' b.
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
// Returns a p a': a covariance p behind the map a. The last bits are those of (a (a p)')'.
Eigen::MatrixXd propagated(const Eigen::MatrixXd& a, const Eigen::MatrixXd& p);
// Returns p + a q a'. The last bits are those of p + (a q) a'.
Eigen::MatrixXd plus_propagated(const Eigen::MatrixXd& p, const Eigen::MatrixXd& a, const Eigen::MatrixXd& q);
// Returns column row.
Eigen::MatrixXd outer(const Eigen::VectorXd& column, const Eigen::RowVectorXd& row);
// Returns the trace of a' b: the sum of all products of equal places.
double inner(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace ttf::experiments::cost
