#include "experiments/cost/timetable.h"

#include <limits>

#include "core/check.h"
#include "experiments/cost/dense.h"

namespace ttf::experiments::cost {

using Eigen::MatrixXd;

double timetable_cost(const Flow& flow, double round, const std::vector<TimedJump>& jumps) {
  constexpr int kMostDoublings = 64;
  TTF_CHECK(!jumps.empty() && jumps.front().at >= 0.0 && jumps.back().at < round, "a round of {} without jumps", round);
  const Eigen::Index n = flow.a.rows();
  // From the first jump, before it is executed, to the next round's.
  std::vector<FlowStep> steps;
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const double dt = (i + 1 < jumps.size() ? jumps[i + 1].at : jumps.front().at + round) - jumps[i].at;
    TTF_CHECK(dt >= 0.0, "a jump {} before the one before it", dt);
    steps.push_back(dt > 0.0 ? step_of(flow, dt)
                             : FlowStep{MatrixXd::Identity(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), 0.0});
  }
  MatrixXd a = MatrixXd::Identity(n, n), moment = MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const MatrixXd through = product(steps[i].phi, jumps[i].jump.e);
    moment = propagated(through, moment) + propagated(steps[i].phi, jumps[i].jump.noise) + steps[i].noise;
    a = product(through, a);
  }
  bool stable = false;
  for (int doubling = 0; doubling < kMostDoublings && !stable; ++doubling) {
    moment = plus_propagated(moment, a, moment);
    a = product(a, a);
    const double left = a.cwiseAbs().maxCoeff();
    if (!(left < 1e100)) break;
    stable = left < 1e-18;
  }
  if (!stable) return std::numeric_limits<double>::infinity();
  double cost = 0.0;
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    moment = propagated(jumps[i].jump.e, moment) + jumps[i].jump.noise;
    cost += inner(steps[i].q, moment) + steps[i].constant;
    moment = propagated(steps[i].phi, moment) + steps[i].noise;
  }
  return cost / round;
}

}  // namespace ttf::experiments::cost
