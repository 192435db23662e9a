#include "schedules/synthesis/solver/bounds.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/decide.h"
#include "schedules/synthesis/solver/model.h"
#include "schedules/synthesis/solver/turns.h"

namespace ttf::schedules::synthesis::solver {
namespace {

constexpr std::int64_t kSplitsOfAPair = 100, kSplitsToWriteDown = 10;

bool chains_contradict(const Problem& problem, const Chain& a, const Chain& b, std::int64_t& splits) {
  std::vector<std::size_t> activities = a.activities;
  activities.insert(activities.end(), b.activities.begin(), b.activities.end());
  Part part = part_of(problem, activities);
  part.add(a);
  part.add(b);
  const Problem pair = folded(std::move(part.problem));
  const Model model({pair, {}, {}});
  if (model.contradictory) return true;
  const Rules rules(model);
  if (rules.windows.size() > Turns::kMostNumbers) return false;
  Turns turns(rules);
  const bool none = turns.run(kSplitsOfAPair) == Turns::End::kExhausted;
  splits -= turns.splits() + kSplitsToWriteDown;
  return none;
}

}  // namespace

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

bool two_chains_contradict(const Problem& problem, std::int64_t& splits) {
  for (std::size_t a = 0; a < problem.chains.size(); ++a)
    for (std::size_t b = a + 1; b < problem.chains.size() && splits > 0; ++b)
      if (problem.chains[a].largest_age && problem.chains[b].largest_age &&
          chains_contradict(problem, problem.chains[a], problem.chains[b], splits))
        return true;
  return false;
}

Problem folded(Problem problem) {
  bool turns = !problem.activities.empty();
  Ticks together = 1;
  std::vector<char> held(problem.activities.size(), 0);
  std::erase_if(problem.precedences, [&](const Precedence& precedence) {
    const Ticks period = problem.activities[precedence.before].period;
    return precedence.most.value_or(precedence.gap + period - 1) - precedence.gap >= period - 1;
  });
  for (const Precedence& precedence : problem.precedences) held[precedence.before] = held[precedence.after] = 1;
  for (std::size_t at = 0; at < problem.activities.size(); ++at) {
    Activity& activity = problem.activities[at];
    const bool whole = held[at] == 0 && activity.period % activity.grid.period == 0 &&
                       activity.window.last - activity.window.first >= activity.period - 1;
    if (whole) activity.window = {0, activity.period - 1};
    turns = turns && whole && !activity.fixed;
    together = std::lcm(together, activity.grid.period);
  }
  if (!turns) return problem;
  Activity& longest = *std::ranges::max_element(problem.activities, {}, &Activity::period);
  if (longest.period % together == 0) longest.window.last = together - 1;
  return problem;
}

}  // namespace ttf::schedules::synthesis::solver
