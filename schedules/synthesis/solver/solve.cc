#include "schedules/synthesis/solver/solve.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/decide.h"
#include "schedules/synthesis/solver/goal.h"
#include "schedules/synthesis/solver/raster.h"

namespace ttf::schedules::synthesis::solver {
namespace {

class Descent {
 public:
  Descent(const Goal& goal, const Tightened& tightened, Decider& decider, Solution& best)
      : goal_(goal), tightened_(tightened), decider_(decider), best_(best), value_(goal.value(best)),
        bound_(std::min(goal.least(), value_)) {}

  Reached run() {
    by_search();
    if (decider_.can_prove()) by_proof();
    if (bound_ < value_) way_ = "not proven";
    return {static_cast<double>(value_), static_cast<double>(bound_), bound_ == value_, way_};
  }

 private:
  // Asks whether the value may be `most`, and takes the answer.
  Verdict::Kind ask(Ticks most, bool search) {
    Tightened asked = tightened_;
    goal_.tighten(asked, most);
    const Verdict verdict = search ? decider_.search(asked.question()) : decider_.prove(asked.question());
    if (verdict.kind == Verdict::Kind::kFeasible) {
      best_ = verdict.solution;
      value_ = goal_.value(best_);
      TTF_CHECK(value_ <= most, "value {} above {}", value_, most);
    } else if (verdict.kind == Verdict::Kind::kInfeasible && most >= bound_) {
      bound_ = most + 1;
      way_ = decider_.way();
    }
    return verdict.kind;
  }

  // Halves the range between the bound and the best value. A question without an answer counts as no for the way down, and leaves
  // the bound where it is.
  void by_search() {
    Ticks below = bound_;
    for (bool first = true; below < value_; first = false) {
      const Ticks most = first ? below : below + (value_ - below) / 2;
      if (ask(most, true) != Verdict::Kind::kFeasible) below = most + 1;
    }
  }

  // The best value is often the least one already, so one question may be the last; else it leaps down ever further, and halves.
  void by_proof() {
    for (Ticks leap = 1; bound_ < value_; leap *= 2) {
      const Verdict::Kind kind = ask(std::max(bound_, value_ - leap), false);
      if (kind == Verdict::Kind::kUnknown) return;
      if (kind == Verdict::Kind::kInfeasible) break;
    }
    while (bound_ < value_)
      if (ask(bound_ + (value_ - bound_) / 2, false) == Verdict::Kind::kUnknown) return;
  }

  const Goal& goal_;
  const Tightened& tightened_;
  Decider& decider_;
  Solution& best_;
  Ticks value_, bound_;
  std::string way_ = "placement meets the bound";
};

}  // namespace

Outcome solve(const Problem& problem, std::span<const Objective> objectives, const Effort& effort, Prover* prover) {
  TTF_CHECK(mistakes(problem).empty(), "the problem makes no sense: {}", mistakes(problem).front());
  Decider decider(effort, prover);
  Tightened tightened{problem, {}, {}};
  const Verdict any = decider.decide(tightened.question());
  Outcome outcome;
  outcome.proven_infeasible = any.kind == Verdict::Kind::kInfeasible;
  if (outcome.proven_infeasible) outcome.way = decider.way();
  if (any.kind != Verdict::Kind::kFeasible) return outcome;
  Solution best = any.solution;
  for (const Objective& objective : objectives) {
    if (objective.kind == Objective::Kind::kFunction) {
      // Later objectives would have to keep its value: they see the offsets it chose as fixed.
      outcome.reached.push_back(least_on_raster(tightened, objective, effort, decider, best));
      for (std::size_t at = 0; at < best.offsets.size(); ++at)
        if (objective.moving.empty() || std::ranges::count(objective.moving, at) > 0)
          tightened.problem.activities[at].fixed = best.offsets[at];
      continue;
    }
    const Goal goal(problem, objective);
    decider.renew();
    outcome.reached.push_back(Descent(goal, tightened, decider, best).run());
    goal.tighten(tightened, static_cast<Ticks>(outcome.reached.back().value));
  }
  outcome.solution = best;
  return outcome;
}

}  // namespace ttf::schedules::synthesis::solver
