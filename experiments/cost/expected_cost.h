// The expected quadratic cost of a control loop under random delays, without any draws: a jump linear system.
//
// A period of `grains` steps begins with stage 0. Each stage runs a random number of grains after the one before, independent of
// the state, at most until the end of the period. A stage that would come later, or never, is left out in this period. Between stages the
// state flows (flow.h), in a stage it jumps: x+ = jump x + v. Stages are samplers, controllers and actuators; which states a
// jump sets is the loop's matter (control_loop.h).
//
// The second moment M = E x x' after stage 0 goes through the period linearly: M+ = L(M) + R. Every way through the stages, with
// its probability, is in L, which so has the mean over the delays. The loop is mean square stable if the spectral radius of L is
// below 1; then M = L(M) + R has one solution. The cost per unit of time is that of the stationary period.
//
// The mathematics is Jitterbug's (Lincoln, Cervin: "Jitterbug: a tool for analysis of real-time control performance", CDC 2002).
// The code is another one: it takes L apart by symmetric matrices and needs no Kronecker products. Tests compare the numbers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/cost/flow.h"

namespace ttf::experiments::cost {

// Probabilities of 0, 1, 2, ... grains. If their sum is below 1, the rest is the probability that the next stage is left out.
using Delays = std::vector<double>;
Delays constant_delay(int grains);
Delays uniform_delay(int least, int most);  // both included
// With probability `loss`, the stage does not come.
Delays with_loss(Delays delays, double loss);

struct Jump {
  Eigen::MatrixXd e, noise;
};

struct Stage {
  // By the grains since the beginning of the period; the last one holds for later ones, too. So a controller may know the age
  // of its measurement.
  std::vector<Jump> jumps;
  Delays next;  // until the next stage; unused in the last one
};

struct Timing {
  double grain = 0.0;  // the unit of time of `flow`
  int grains = 0;      // of a period
  std::vector<Stage> stages;
};

struct ExpectedCost {
  double cost = 0.0;             // per unit of time; infinite if not stable
  double spectral_radius = 0.0;  // the share of a second moment that L leaves
  Eigen::MatrixXd moment;        // M; empty if not stable

  bool stable() const { return spectral_radius < 1.0; }
};
ExpectedCost expected_cost(const Flow& flow, const Timing& timing);

}  // namespace ttf::experiments::cost
