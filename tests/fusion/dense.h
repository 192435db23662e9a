// Linear algebra of matrices of any size, for oracles. Each fixed-size decomposition with a solver costs a
// second or more to compile. These are compiled once (dense.cc).
#pragma once

#include <Eigen/Core>

namespace ttf::fusion {

// A matrix, or a vector as one column, whose operators are functions. Eigen's would compile each formula anew.
struct Dense : Eigen::MatrixXd {
  Dense() = default;
  template <class Other> Dense(const Eigen::MatrixBase<Other>& other) : Eigen::MatrixXd(other) {}
  Dense transpose() const;
};
Dense operator*(const Dense& a, const Dense& b);
Dense operator+(const Dense& a, const Dense& b);
Dense operator-(const Dense& a, const Dense& b);

Dense inverse(const Eigen::MatrixXd& a);                                  // by LU with partial pivoting
Dense solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);          // A^-1 B of a symmetric A, by LDLT
double norm_squared(const Eigen::VectorXd& e, const Eigen::MatrixXd& p);  // e' P^-1 e, by LDLT
double least_eigenvalue(const Eigen::MatrixXd& a);                        // A is symmetric: its lower triangle

}  // namespace ttf::fusion
