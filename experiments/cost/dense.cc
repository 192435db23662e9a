#include "experiments/cost/dense.h"

namespace ttf::experiments::cost {

using Eigen::MatrixXd;

MatrixXd product(const MatrixXd& a, const MatrixXd& b) { return a * b; }

MatrixXd transposed_product(const MatrixXd& a, const MatrixXd& b) { return a.transpose() * b; }

MatrixXd propagated(const MatrixXd& a, const MatrixXd& p) { return product(a, product(a, p).transpose()).transpose(); }

MatrixXd plus_propagated(const MatrixXd& p, const MatrixXd& a, const MatrixXd& q) {
  return p + product(product(a, q), a.transpose());
}

MatrixXd outer(const Eigen::VectorXd& column, const Eigen::RowVectorXd& row) { return column * row; }

double inner(const MatrixXd& a, const MatrixXd& b) { return a.cwiseProduct(b).sum(); }

}  // namespace ttf::experiments::cost
