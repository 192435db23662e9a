// A linear system with white noise and a quadratic cost, over one step of time.
//
//   dx = a x dt + dw,   E dw dw' = noise dt,   cost rate x' q x
// Over a step dt the state becomes phi x + v, and the expected cost of the step is
//   x' q_step x + constant,
//   phi = exp(a dt),   E v v' = int_0^dt exp(a s) noise exp(a' s) ds,
//   q_step = int_0^dt exp(a' s) q exp(a s) ds,   constant = int_0^dt tr(noise q_step(s)) ds.
// All integrals are blocks of matrix exponentials (Van Loan: "Computing integrals involving the matrix exponential", IEEE
// Transactions on Automatic Control 23, 1978).
#pragma once

#include <Eigen/Core>

namespace ttf::experiments::cost {

struct Flow {
  Eigen::MatrixXd a, noise, q;  // noise and q: symmetric, not negative
};

struct FlowStep {
  Eigen::MatrixXd phi, noise, q;
  double constant = 0.0;
};

// dt > 0 in the unit of time of `flow`.
FlowStep step_of(const Flow& flow, double dt);

// By scaling and squaring, with a Taylor series of the scaled matrix, whose norm is at most 1/2.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& a);

}  // namespace ttf::experiments::cost
