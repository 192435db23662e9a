#include "schedules/synthesis/solver/explain.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/decide.h"
#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::solver {
namespace {

using Kind = Verdict::Kind;

std::vector<Statement> statements_of(const Problem& problem) {
  std::vector<Statement> all;
  for (std::size_t at = 0; at < problem.activities.size(); ++at) all.push_back({Statement::Kind::kWindow, at});
  for (std::size_t at = 0; at < problem.precedences.size(); ++at) all.push_back({Statement::Kind::kPrecedence, at});
  for (std::size_t at = 0; at < problem.resources.size(); ++at) all.push_back({Statement::Kind::kResource, at});
  for (std::size_t at = 0; at < problem.chains.size(); ++at)
    if (problem.chains[at].largest_age) all.push_back({Statement::Kind::kAge, at});
  return all;
}

// So far from the windows, an offset that precedences alone bind need not go.
Window anywhere(const Problem& problem) {
  Ticks reach = 1, first = 0, last = 0;
  for (const Precedence& precedence : problem.precedences)
    reach += std::abs(precedence.gap) + std::abs(precedence.most.value_or(0)) +
             problem.activities[precedence.before].duration + problem.activities[precedence.before].period;
  for (const Activity& activity : problem.activities) {
    first = std::min({first, activity.window.first, activity.fixed.value_or(0)});
    last = std::max({last, activity.window.last, activity.fixed.value_or(0)});
  }
  return {first - reach, last + reach};
}

// The problem with some of its statements alone. The numbers of chains stay.
Problem with(const Problem& problem, const std::vector<Statement>& kept) {
  Problem made = problem;
  const auto keeps = [&](Statement::Kind kind, std::size_t at) {
    return std::ranges::count(kept, Statement{kind, at}) > 0;
  };
  const Window free = anywhere(problem);
  for (std::size_t at = 0; at < made.activities.size(); ++at) {
    Activity& activity = made.activities[at];
    if (activity.resource && !keeps(Statement::Kind::kResource, *activity.resource)) activity.resource.reset();
    if (keeps(Statement::Kind::kWindow, at)) continue;
    activity.window = free;
    activity.grid = {};
    activity.fixed.reset();
  }
  made.precedences.clear();
  for (std::size_t at = 0; at < problem.precedences.size(); ++at)
    if (keeps(Statement::Kind::kPrecedence, at)) made.precedences.push_back(problem.precedences[at]);
  for (std::size_t at = 0; at < made.chains.size(); ++at)
    if (!keeps(Statement::Kind::kAge, at)) made.chains[at].largest_age.reset();
  return made;
}

class Reduction {
 public:
  Reduction(const Problem& problem, const Effort& effort, Prover* prover)
      : problem_(problem), decider_(effort, prover) {}

  Kind decide(const std::vector<Statement>& kept) {
    decider_.renew();
    return decider_.decide({with(problem_, kept), {}, {}}).kind;
  }

  // Drops statements in halving blocks as long as what is left has no solution, then one by one.
  std::vector<Statement> reduced(std::vector<Statement> core) {
    for (std::size_t block = core.size() / 2; block > 0; block /= 2)
      for (std::size_t at = 0; at < core.size();) {
        std::vector<Statement> fewer(core.begin(), core.begin() + static_cast<std::ptrdiff_t>(at));
        fewer.insert(fewer.end(), core.begin() + static_cast<std::ptrdiff_t>(std::min(at + block, core.size())),
                     core.end());
        if (decide(fewer) == Kind::kInfeasible)
          core = std::move(fewer);
        else
          at += block;
      }
    return core;
  }

  bool smallest(const std::vector<Statement>& core) {
    for (std::size_t at = 0; at < core.size(); ++at) {
      std::vector<Statement> fewer = core;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at));
      if (decide(fewer) != Kind::kFeasible) return false;
    }
    return true;
  }

 private:
  const Problem& problem_;
  Decider decider_;
};

// The least age of a chain while all the rest is kept.
std::optional<Ticks> least_age(const Problem& problem, std::size_t chain, const Effort& effort, Prover* prover) {
  Problem free = problem;
  free.chains[chain].largest_age.reset();
  Objective objective;
  objective.which = {chain};
  const Outcome outcome = solve(free, {&objective, 1}, effort, prover);
  if (!outcome.solution) return std::nullopt;
  return static_cast<Ticks>(outcome.reached.front().value);
}

}  // namespace

Explanation explain(const Problem& problem, const Effort& effort, Prover* prover) {
  TTF_CHECK(mistakes(problem).empty(), "the problem makes no sense: {}", mistakes(problem).front());
  Reduction reduction(problem, effort, prover);
  std::vector<Statement> all = statements_of(problem);
  if (reduction.decide(all) != Kind::kInfeasible) return {};
  Explanation explanation;
  explanation.core = reduction.reduced(std::move(all));
  explanation.smallest = reduction.smallest(explanation.core);
  Ticks smallest_growth = kNoLimit;
  for (const Statement& statement : explanation.core) {
    if (statement.kind != Statement::Kind::kAge) continue;
    const std::optional<Ticks> age = least_age(problem, statement.index, effort, prover);
    const Ticks growth = age ? *age - *problem.chains[statement.index].largest_age : kNoLimit;
    if (growth >= smallest_growth) continue;
    smallest_growth = growth;
    explanation.change = {statement.index, *age};
  }
  return explanation;
}

}  // namespace ttf::schedules::synthesis::solver
