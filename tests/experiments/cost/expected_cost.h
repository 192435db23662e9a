// The expected quadratic cost of a control loop under random delays, without any draws: a jump linear system.
//
// A period of `grains` steps begins with stage 0. Each stage runs a random number of grains after the one before, independent of
// the state. A stage that would come after the end of the period, or never, is left out in it, and so are those behind it.
// Between stages the state flows (flow.h). In a stage it jumps (control_loop.h). Stages are samplers, controllers and actuators.
//
// The second moment M = E x x' after stage 0 goes through the period linearly: M+ = L(M) + R. L is the mean over the delays. The
// loop is mean square stable if the spectral radius of L is below 1. Then M = L(M) + R has one solution. The cost per unit of
// time is that of the stationary period.
//
// The mathematics is Jitterbug's (Lincoln, Cervin: "Jitterbug: a tool for analysis of real-time control performance", CDC 2002).
// The code is another one: it finds L by the symmetric unit matrices and needs no Kronecker products. Tests compare the numbers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/cost/control_loop.h"
#include "experiments/cost/flow.h"

namespace ttf::experiments::cost {

// Probabilities of 0, 1, 2, ... grains. If their sum is below 1, the rest is the probability that the next stage is left out.
using Delays = std::vector<double>;
Delays constant_delay(int grains);
Delays uniform_delay(int least, int most);  // [grains], both included
// The next stage is left out with the probability `loss`.
Delays with_loss(Delays delays, double loss);

struct Stage {
  // By the grains since the beginning of the period. The last one holds for later grains, too. So a controller may have the
  // age of its measurement.
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
  double spectral_radius = 0.0;  // of L
  Eigen::MatrixXd moment;        // M; empty if not stable

  bool stable() const { return spectral_radius < 1.0; }
};
ExpectedCost expected_cost(const Flow& flow, const Timing& timing);

}  // namespace ttf::experiments::cost
