#include "tests/fusion/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace ttf::fusion::dense {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd inverse(const MatrixXd& a) { return a.inverse(); }
MatrixXd solve(const MatrixXd& a, const MatrixXd& b) { return a.ldlt().solve(b); }
double norm_squared(const VectorXd& e, const MatrixXd& p) { return e.dot(p.ldlt().solve(e)); }
double least_eigenvalue(const MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues()(0);   // ascending
}

Correction update(const VectorXd& x, const MatrixXd& p, const VectorXd& z, const MatrixXd& h, const MatrixXd& r) {
  Correction c;
  c.nu = z - h * x;
  const MatrixXd hp = h * p;
  const MatrixXd s = hp * h.transpose() + r;
  c.s = 0.5 * (s + s.transpose());
  c.k = solve(c.s, hp).transpose();
  c.x = x + c.k * c.nu;
  const MatrixXd a = MatrixXd::Identity(x.size(), x.size()) - c.k * h;
  const MatrixXd joseph = a * p * a.transpose() + c.k * r * c.k.transpose();
  c.p = 0.5 * (joseph + joseph.transpose());
  return c;
}

}  // namespace ttf::fusion::dense
