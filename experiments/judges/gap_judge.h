// The objective `gap_error` of a plan: the expected squared error of the gap of a vehicle that follows another one
// (following.h).
//
// A command acts when a chain's task begins, and plan.gap_error.delay later. Each chain closes the loop by itself. The
// chain with the largest error has the value.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/judges/following.h"
#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::experiments::judges {

class GapJudge : public schedules::synthesis::instants::judging::Judge {
 public:
  explicit GapJudge(const schedules::synthesis::plan::Plan& plan);

  double of(const std::vector<schedules::synthesis::instants::judging::ChainEnd>& chain_ends,
            const std::vector<double>& weights) const override;
  // Where a sensor measures as often as it is used, the loop has one age. The bound is the error at the least one. This
  // supposes that the error grows with the age. Sixteen ages over a period are tried. If the error falls from one to
  // the next, the bound is 0, as it is for other periods.
  double bound(const std::vector<schedules::synthesis::instants::judging::Prospect>& prospects,
               const std::vector<double>& weights, double enough, int effort) const override;
  std::string supposes() const override;

  static constexpr int kSteps = 16;

 private:
  double at_age(Duration period, Duration age) const;

  FollowingVehicle vehicle_;
  Duration delay_;
  mutable std::map<std::pair<Duration, Duration>, double> known_;  // by period and age
};

}  // namespace ttf::experiments::judges
