#include "tests/experiments/cost/expected_cost.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace ttf::experiments::cost {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Second moments times the probability of being there, and that probability.
struct Mass {
  MatrixXd moment;
  double probability = 0.0;
};

class Period {
 public:
  Period(const Flow& flow, const Timing& timing) : timing_(timing), step_(step_of(flow, timing.grain)) {
    flows_.push_back({MatrixXd::Identity(flow.a.rows(), flow.a.rows()), MatrixXd::Zero(flow.a.rows(), flow.a.rows())});
    for (int grain = 0; grain < timing.grains; ++grain) flows_.push_back(stepped(flows_.back()));
  }

  // Takes a moment after stage 0 to the one after the next stage 0. Without noise the map is L. Adds the
  // cost of the period to `cost`, if given.
  MatrixXd through(const MatrixXd& moment, bool noise, double* cost = nullptr) const {
    const std::size_t stages = timing_.stages.size();
    const double one = noise ? 1.0 : 0.0;
    // By stage and grain: the mass that has just run the stage then.
    std::vector<std::vector<Mass>> run(stages, std::vector<Mass>(flows_.size()));
    run[0][0] = {moment, 1.0};
    MatrixXd all = moment;
    for (std::size_t grain = 0; grain < flows_.size(); ++grain) {
      if (grain > 0) {
        if (cost != nullptr) *cost += step_.q.cwiseProduct(all).sum() + step_.constant;
        all = step_.phi * all * step_.phi.transpose() + one * step_.noise;
      }
      for (std::size_t stage = 1; stage < stages; ++stage) {
        const Mass before = arriving(run[stage - 1], timing_.stages[stage - 1].next, grain, one);
        if (before.probability == 0.0) continue;
        const Mass after = jumped(timing_.stages[stage], grain, before, one);
        all += after.moment - before.moment;
        run[stage][grain] = after;
      }
    }
    return jumped(timing_.stages[0], 0, {all, 1.0}, one).moment;
  }

 private:
  // From the beginning of a wait, by grains: x = phi x + v.
  struct Flowed {
    MatrixXd phi, noise;
  };
  Flowed stepped(const Flowed& before) const {
    return {step_.phi * before.phi, step_.phi * before.noise * step_.phi.transpose() + step_.noise};
  }

  Mass arriving(const std::vector<Mass>& run, const Delays& delays, std::size_t grain, double one) const {
    Mass sum{MatrixXd::Zero(step_.phi.rows(), step_.phi.rows()), 0.0};
    for (std::size_t began = 0; began <= grain; ++began) {
      const std::size_t waited = grain - began;
      if (run[began].probability == 0.0 || waited >= delays.size() || delays[waited] == 0.0) continue;
      const Flowed& flowed = flows_[waited];
      sum.moment += delays[waited] * (flowed.phi * run[began].moment * flowed.phi.transpose() +
                                      (one * run[began].probability) * flowed.noise);
      sum.probability += delays[waited] * run[began].probability;
    }
    return sum;
  }

  static Mass jumped(const Stage& stage, std::size_t grain, const Mass& before, double one) {
    const Jump& jump = stage.jumps[std::min(grain, stage.jumps.size() - 1)];
    return {jump.e * before.moment * jump.e.transpose() + (one * before.probability) * jump.noise, before.probability};
  }

  const Timing& timing_;
  FlowStep step_;
  std::vector<Flowed> flows_;
};

// The upper triangle of a symmetric matrix, by columns.
VectorXd packed(const MatrixXd& m) {
  VectorXd values(m.rows() * (m.rows() + 1) / 2);
  Index at = 0;
  for (Index column = 0; column < m.rows(); ++column)
    for (Index row = 0; row <= column; ++row) values[at++] = m(row, column);
  return values;
}

MatrixXd unpacked(const VectorXd& values, Index n) {
  MatrixXd m(n, n);
  Index at = 0;
  for (Index column = 0; column < n; ++column)
    for (Index row = 0; row <= column; ++row) m(row, column) = m(column, row) = values[at++];
  return m;
}

// lim |l^k|^(1/k) by squarings. After 2^50 periods the start is beyond a double's digits.
double spectral_radius(MatrixXd l) {
  double logarithm = 0.0, share = 1.0;
  for (int squaring = 0; squaring < 50; ++squaring) {
    const double norm = l.cwiseAbs().maxCoeff();
    if (norm == 0.0) return 0.0;
    logarithm += share * std::log(norm);
    l /= norm;
    l = MatrixXd(l * l);
    share *= 0.5;
  }
  return std::exp(logarithm);
}

void check(const Flow& flow, const Timing& timing) {
  TTF_CHECK(timing.grain > 0.0 && timing.grains > 0 && !timing.stages.empty(), "{} grains", timing.grains);
  for (const Stage& stage : timing.stages) {
    TTF_CHECK(!stage.jumps.empty() && stage.jumps[0].e.rows() == flow.a.rows(), "a stage without its jump");
    double sum = 0.0;
    for (const double probability : stage.next) {
      TTF_CHECK(probability >= 0.0, "a probability of {}", probability);
      sum += probability;
    }
    TTF_CHECK(sum <= 1.0 + 1e-9, "probabilities of {} together", sum);
  }
}

}  // namespace

Delays constant_delay(int grains) {
  Delays delays(static_cast<std::size_t>(grains) + 1, 0.0);
  delays.back() = 1.0;
  return delays;
}

Delays uniform_delay(int least, int most) {
  Delays delays(static_cast<std::size_t>(most) + 1, 0.0);
  for (int grain = least; grain <= most; ++grain) delays[static_cast<std::size_t>(grain)] = 1.0 / (most - least + 1);
  return delays;
}

Delays with_loss(Delays delays, double loss) {
  for (double& probability : delays) probability *= 1.0 - loss;
  return delays;
}

ExpectedCost expected_cost(const Flow& flow, const Timing& timing) {
  check(flow, timing);
  const Period period(flow, timing);
  const Index n = flow.a.rows(), size = n * (n + 1) / 2;
  MatrixXd l(size, size);
  for (Index column = 0; column < size; ++column)
    l.col(column) = packed(period.through(unpacked(VectorXd::Unit(size, column), n), false));
  ExpectedCost result;
  result.spectral_radius = spectral_radius(l);
  if (!result.stable()) {
    result.cost = std::numeric_limits<double>::infinity();
    return result;
  }
  const VectorXd noise = packed(period.through(MatrixXd::Zero(n, n), true));
  result.moment = unpacked((MatrixXd::Identity(size, size) - l).partialPivLu().solve(noise), n);
  period.through(result.moment, true, &result.cost);
  result.cost /= timing.grain * timing.grains;
  return result;
}

}  // namespace ttf::experiments::cost
