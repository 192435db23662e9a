#include "schedules/synthesis/solver/bounds.h"

#include <algorithm>
#include <map>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/decide.h"
#include "schedules/synthesis/solver/model.h"

namespace ttf::schedules::synthesis::solver {

Part part_of(const Problem& problem, std::span<const std::size_t> activities) {
  Part part;
  part.problem.resources = problem.resources;
  std::vector<char> taken(problem.activities.size(), 0), resources(problem.resources.size(), 0);
  for (const std::size_t at : activities) {
    taken[at] = 1;
    if (problem.activities[at].resource) resources[*problem.activities[at].resource] = 1;
  }
  for (std::size_t at = 0; at < problem.activities.size(); ++at) {
    const Activity& activity = problem.activities[at];
    if (activity.fixed && activity.resource && resources[*activity.resource]) taken[at] = 1;
  }
  std::map<std::size_t, std::size_t> places;
  for (std::size_t at = 0; at < taken.size(); ++at) {
    if (!taken[at]) continue;
    places[at] = part.numbers.size();
    part.numbers.push_back(at);
    part.problem.activities.push_back(problem.activities[at]);
  }
  for (Precedence precedence : problem.precedences) {
    if (!places.contains(precedence.before) || !places.contains(precedence.after)) continue;
    precedence.before = places[precedence.before];
    precedence.after = places[precedence.after];
    part.problem.precedences.push_back(precedence);
  }
  return part;
}

void Part::add(Chain chain) {
  for (std::size_t& activity : chain.activities)
    activity = static_cast<std::size_t>(std::ranges::lower_bound(numbers, activity) - numbers.begin());
  problem.chains.push_back(std::move(chain));
}

Ticks least_age_alone(const Problem& problem, const Chain& chain) {
  Part part = part_of(problem, chain.activities);
  Chain own = chain;
  own.largest_age.reset();
  part.add(own);
  own = part.problem.chains.front();
  Decider decider({.steps = 1000, .exhaustion = 2000}, nullptr);
  Ticks least = terms_of(part.problem, own).base;
  const Verdict any = decider.search({part.problem, {}, {}});
  if (any.kind != Verdict::Kind::kFeasible) return least;
  Ticks most = age(part.problem, own, any.solution);
  while (least < most) {
    const Ticks middle = least + (most - least) / 2;
    part.problem.chains[0].largest_age = middle;
    const Verdict verdict = decider.search({part.problem, {}, {}});
    if (verdict.kind == Verdict::Kind::kUnknown) break;  // the bound so far holds
    if (verdict.kind == Verdict::Kind::kFeasible)
      most = age(part.problem, own, verdict.solution);
    else
      least = middle + 1;
  }
  return least;
}

}  // namespace ttf::schedules::synthesis::solver
