// The objectives of a plan, one after the other, over all candidates (synthesize.h).
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "schedules/synthesis/instants/judging/judge.h"
#include "schedules/synthesis/instants/judging/trial.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::instants::objectives {

using judging::Judges;
using judging::Trial;

class Optimiser {
 public:
  // Candidates in `refused` are left out. Every objective that is not this module's own must have its judge.
  Optimiser(const plan::Plan& plan, const std::vector<Candidate>& all, const std::set<std::size_t>& refused,
            const Judges& judges);

  // Returns the index of the best candidate; none if no candidate has a placement.
  std::optional<std::size_t> run();

  const Trial& trial(std::size_t index) const { return trials_[index]; }
  const std::vector<Reached>& reached() const { return reached_; }
  // Whether every candidate without a placement has none.
  bool exact() const { return exact_; }

 private:
  // A candidate whose search was cut: no worst age below `least` is possible there.
  struct Open {
    std::size_t trial = 0;
    Ticks least = 0;
    bool nothing = false;  // the search found no placement
  };

  void worst_age(plan::Goal goal);
  // Searches candidates again whose search was cut, those with the least bounds first. Only placements better than
  // the best of all are looked for: this limit ends more ways early. The first candidate that stays open is the last, as others would prove nothing.
  // Returns a bound for all of them, and raises that of each one.
  Ticks settle_open(std::vector<Open>& open, Ticks& best);
  void slots();
  // Returns the least last slot within the trial's limits, and whether it is proven to be the least. Keeps its
  // placement.
  std::pair<std::optional<Ticks>, bool> fewest(const Read& read, Trial& trial);
  // Sees to it that every trial has a placement, and drops those without one.
  void place_all();
  void jitter();
  void room();
  void judge(plan::Goal goal);
  std::optional<std::size_t> least_sum();
  void note(plan::Goal goal, double value, double bound);
  // Returns an objective's bound over the doubtful trials, whatever their instants.
  double bound_of_doubtful(plan::Goal goal) const;

  const plan::Plan& plan_;
  const Judges& judges_;
  std::string way_;  // to the proof of this objective
  std::vector<Trial> trials_;
  // Trials that might be as good as those that are left, with other instants: they were dropped without a proof of the
  // contrary, or a judge has chosen their measurements and uses.
  std::set<std::size_t> doubtful_;
  bool judged_ = false;
  std::vector<Trial> possible_;  // before the first judge: those that were left, and the doubtful ones
  std::vector<Reached> reached_;
  bool exact_ = true;
};

}  // namespace ttf::schedules::synthesis::instants::objectives
