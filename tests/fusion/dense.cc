#include "tests/fusion/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace ttf::fusion {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Dense Dense::transpose() const { return MatrixXd::transpose(); }
Dense operator*(const Dense& a, const Dense& b) { return a.lazyProduct(b); }
Dense operator+(const Dense& a, const Dense& b) { return a.MatrixXd::operator+(b); }
Dense operator-(const Dense& a, const Dense& b) { return a.MatrixXd::operator-(b); }

Dense inverse(const MatrixXd& a) { return a.inverse(); }
Dense solve(const MatrixXd& a, const MatrixXd& b) { return a.ldlt().solve(b); }
double norm_squared(const VectorXd& e, const MatrixXd& p) { return e.dot(p.ldlt().solve(e)); }
double least_eigenvalue(const MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues()(0);  // ascending
}

}  // namespace ttf::fusion
