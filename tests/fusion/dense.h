// Linear algebra of matrices of any size, for oracles. Each fixed-size decomposition with a solver costs a
// second or more to compile. These are compiled once (dense.cc).
#pragma once

#include <Eigen/Core>

namespace ttf::fusion {

Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);                          // by LU with partial pivoting
Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);  // A^-1 B of a symmetric A, by LDLT
double norm_squared(const Eigen::VectorXd& e, const Eigen::MatrixXd& p);    // e' P^-1 e, by LDLT
double least_eigenvalue(const Eigen::MatrixXd& a);                          // A is symmetric: its lower triangle

}  // namespace ttf::fusion
