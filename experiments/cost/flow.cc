#include "experiments/cost/flow.h"

#include <cmath>

#include "core/check.h"
#include "experiments/cost/dense.h"

namespace ttf::experiments::cost {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

double row_sum_norm(const MatrixXd& a) { return a.cwiseAbs().rowwise().sum().maxCoeff(); }

MatrixXd symmetric(const MatrixXd& a) { return 0.5 * (a + a.transpose()); }

}  // namespace

MatrixXd exponential(const MatrixXd& a) {
  const double norm = row_sum_norm(a);
  TTF_CHECK(std::isfinite(norm) && norm < 1e6, "exponential of a matrix of norm {}", norm);
  const int squarings = norm > 0.5 ? static_cast<int>(std::ceil(std::log2(2.0 * norm))) : 0;
  const MatrixXd scaled = std::ldexp(1.0, -squarings) * a;
  MatrixXd term = MatrixXd::Identity(a.rows(), a.cols()), sum = term;
  for (int n = 1; n <= 16; ++n) {  // 0.5^17 / 17! is 2e-20
    term = product(term, scaled) / n;
    sum += term;
  }
  for (int n = 0; n < squarings; ++n) sum = product(sum, sum);
  return sum;
}

namespace {

// One step, and then the same again.
FlowStep twice(const FlowStep& half) {
  FlowStep step;
  step.phi = product(half.phi, half.phi);
  step.noise = plus_propagated(half.noise, half.phi, half.noise);
  step.q = half.q + product(transposed_product(half.phi, half.q), half.phi);
  step.constant = 2.0 * half.constant + inner(half.noise, half.q);
  return step;
}

}  // namespace

FlowStep step_of(const Flow& flow, double dt) {
  // exp(-a dt) and exp(a dt) lose the digits of their product in longer steps.
  constexpr double kLongest = 8.0;
  if (dt * row_sum_norm(flow.a) > kLongest) return twice(step_of(flow, dt / 2.0));
  const Index n = flow.a.rows();
  FlowStep step;
  // exp of [-a', 1, 0; 0, -a', q; 0, 0, a] dt. Its last column has exp(-a' dt) times the integral of q_step, exp(-a' dt) times
  // q_step, and phi.
  MatrixXd costs = MatrixXd::Zero(3 * n, 3 * n);
  costs.block(0, 0, n, n) = costs.block(n, n, n, n) = -flow.a.transpose();
  costs.block(0, n, n, n).setIdentity();
  costs.block(n, 2 * n, n, n) = flow.q;
  costs.block(2 * n, 2 * n, n, n) = flow.a;
  const MatrixXd integrated = exponential(dt * costs);
  step.phi = integrated.block(2 * n, 2 * n, n, n);
  step.q = symmetric(transposed_product(step.phi, integrated.block(n, 2 * n, n, n)));
  const MatrixXd q_so_far = transposed_product(step.phi, integrated.block(0, 2 * n, n, n));
  step.constant = inner(flow.noise, q_so_far);
  // exp of [-a, noise; 0, a'] dt. Above right it has exp(-a dt) times the noise's covariance.
  MatrixXd noises = MatrixXd::Zero(2 * n, 2 * n);
  noises.block(0, 0, n, n) = -flow.a;
  noises.block(0, n, n, n) = flow.noise;
  noises.block(n, n, n, n) = flow.a.transpose();
  step.noise = symmetric(product(step.phi, exponential(dt * noises).block(0, n, n, n)));
  return step;
}

}  // namespace ttf::experiments::cost
