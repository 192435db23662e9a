// The objective `error` of a plan: the expected squared error of position, on one axis, at the uses of the data.
//
// It is the mean over the uses of a round, and over the tasks that end chains. A service acts at its uses alone. The
// `position_mse` of an experiment counts alike. With `over: time` all time counts: each use holds by prediction until
// the next one. periodic_error.h has the recursion. Each sensor of a chain measures the position, with the plan's
// sigma. Clocks agree, and TT fuses lists in the order of measurements. With several densities each one is a part. The
// value is then the regret.
#pragma once

#include "experiments/judges/periodic_error.h"
#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::experiments::judges {

class ErrorJudge : public schedules::synthesis::instants::judging::Judge {
 public:
  // The plan must have `error`.
  explicit ErrorJudge(const schedules::synthesis::plan::Plan& plan);

  std::size_t parts() const override { return densities_.size(); }
  double of(const std::vector<schedules::synthesis::instants::judging::ChainEnd>& chain_ends,
            const std::vector<double>& weights) const override;
  // By least_error.h: all phases are within the boxes, of which `effort` are looked at.
  double bound(const std::vector<schedules::synthesis::instants::judging::Prospect>& prospects,
               const std::vector<double>& weights, double enough, int effort) const override;

 private:
  Motion motion_;
  bool over_time_;
  std::vector<double> densities_;
  std::vector<double> variances_;  // by chain [m^2]
};

}  // namespace ttf::experiments::judges
