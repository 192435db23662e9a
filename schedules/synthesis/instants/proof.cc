#include "schedules/synthesis/instants/proof.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/check.h"
#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::instants {
namespace {

constexpr Ticks kUnlimited = std::numeric_limits<Ticks>::max();

bool of_one_period(const Problem& problem, const Chain& chain) {
  const auto period = [&](std::size_t activity) { return problem.activities[activity].period; };
  return std::all_of(chain.activities.begin(), chain.activities.end(),
                     [&](std::size_t activity) { return period(activity) == period(chain.activities.front()); });
}

// Returns the numbers of the chains that the solver is given.
std::vector<std::size_t> chains_of_one_period(const Problem& problem) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < problem.chains.size(); ++c)
    if (of_one_period(problem, problem.chains[c])) found.push_back(c);
  return found;
}

// A chain that leads from a sensor to the task that fuses its lists.
struct Led {
  std::size_t chain = 0, at = 0;
  Fused fused;
};

std::vector<Led> led(const Problem& problem, const std::vector<Fused>& fused) {
  std::vector<Led> found;
  for (const Fused& one : fused)
    for (std::size_t c = 0; c < problem.chains.size(); ++c) {
      const std::vector<std::size_t>& way = problem.chains[c].activities;
      const auto at = std::find(way.begin(), way.end(), one.fusing);
      if (way.front() != one.measuring || at == way.end()) continue;
      found.push_back({c, static_cast<std::size_t>(at - way.begin()), one});
      break;
    }
  return found;
}

void add_orders(const Reading& reading, Problem& problem) {
  const std::vector<Led> all = led(problem, reading.fused);
  for (const Led& a : all)
    for (const Led& b : all) {
      if (a.fused.node != b.fused.node || a.fused.fusing == b.fused.fusing) continue;
      if (problem.activities[a.fused.fusing].period != problem.activities[b.fused.fusing].period) continue;
      problem.orders.push_back({a.chain, a.at, b.chain, b.at, reading.order});
    }
}

// Whether all of Plan::in_order is among the problem's orders.
bool all_orders_known(const Reading& reading, const Problem& problem) {
  std::size_t pairs = 0;
  for (const Fused& a : reading.fused)
    for (const Fused& b : reading.fused)
      if (a.node == b.node && a.fusing != b.fusing) ++pairs;
  return pairs == problem.orders.size();
}

// A worst age that every placement keeps.
Ticks largest_worst(const Problem& problem, const Limits& limits) {
  if (limits.worst_age) return *limits.worst_age;
  Ticks largest = 0;
  const std::vector<Ticks> least = least_ages(problem);
  for (std::size_t c = 0; c < problem.chains.size(); ++c) {
    Ticks age = least[c] + (limits.beyond.empty() ? 0 : limits.beyond[c]);
    for (const std::size_t a : problem.chains[c].activities) age += problem.activities[a].period;
    largest = std::max(largest, age);
  }
  return largest;
}

// Returns the worst age as an objective: the most that a chain's age is above its reference, which is `largest` with the chain's own
// end. Chains with a limit below it are counted in a copy.
solver::Objective lateness(const Reading& reading, const Limits& limits, Ticks largest, Problem& problem) {
  solver::Objective worst{solver::Objective::Kind::kLateness, {}, {}, {}, {}, 1};
  const std::vector<std::size_t> numbers = chains_of_one_period(reading.problem);
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    const Ticks beyond = limits.beyond.empty() ? 0 : limits.beyond[numbers[c]];
    const Ticks reference = largest - beyond + problem.activities[problem.chains[c].activities.back()].duration;
    std::size_t counted = c;
    if (problem.chains[c].largest_age.value_or(reference) != reference) {
      counted = problem.chains.size();
      problem.chains.push_back(Chain{problem.chains[c]});
    }
    problem.chains[counted].largest_age = reference;
    worst.which.push_back(counted);
  }
  return worst;
}

// Returns the solver's offsets as a placement, unless they break what the relaxation left out.
std::optional<Placed> placed(const Reading& reading, const Limits& limits, const Problem& asked, Solution solution) {
  if (!all_orders_known(reading, asked)) return std::nullopt;
  const Problem& problem = reading.problem;
  Placed made;
  for (std::size_t c = 0; c < problem.chains.size(); ++c) {
    const Ways found = ways(problem, problem.chains[c], solution.offsets);
    if (found.longest > limit_of(problem, limits, c)) return std::nullopt;
    made.ages.push_back(found.longest);
    made.least.push_back(found.shortest);
  }
  made.solution = std::move(solution);
  if (limits.sum_of_ages && made.sum_of_ages() > *limits.sum_of_ages) return std::nullopt;
  if (limits.jitter && made.jitter() > *limits.jitter) return std::nullopt;
  return made;
}

}  // namespace

std::optional<Problem> relaxed(const Reading& reading, const Limits& limits) {
  const Problem& whole = reading.problem;
  Problem problem{whole.activities, whole.resources, {}, {}, {}};
  for (Activity& activity : problem.activities)
    if (limits.last_slot && activity.resource == kStaticSegment && !activity.fixed)
      activity.grid.last = std::min(activity.grid.last, *limits.last_slot - activity.duration);
  for (const std::size_t c : chains_of_one_period(whole)) {
    Chain chain = whole.chains[c];
    const Ticks limit = limit_of(whole, limits, c);
    chain.largest_age.reset();
    if (limit != kUnlimited) chain.largest_age = limit + whole.activities[chain.activities.back()].duration;
    problem.chains.push_back(std::move(chain));
  }
  add_orders(reading, problem);
  if (!mistakes(problem).empty()) return std::nullopt;
  return problem;
}

Settled settle(const Reading& reading, const Limits& limits, solver::Prover* prover, bool any) {
  std::optional<Problem> problem = relaxed(reading, limits);
  if (!problem || problem->chains.empty()) return {};
  const Ticks largest = largest_worst(reading.problem, limits);
  std::vector<solver::Objective> objectives;
  if (!any) objectives.push_back(lateness(reading, limits, largest, *problem));
  const solver::Outcome outcome = solver::solve(*problem, objectives, {}, prover);
  Settled settled;
  if (!outcome.solution) {
    settled.none = outcome.proven_infeasible;
    settled.open = !settled.none;
    settled.bound = settled.none ? largest + 1 : 0;
    settled.way = outcome.way;
    return settled;
  }
  TTF_CHECK(violations(*problem, *outcome.solution).empty(), "the solver's offsets break the plan's problem");
  settled.best = placed(reading, limits, *problem, *outcome.solution);
  settled.open = !settled.best;
  if (any) return settled;
  const solver::Reached& reached = outcome.reached.front();
  settled.bound = largest + static_cast<Ticks>(reached.bound);
  settled.open = settled.open || settled.best->worst_age(limits.beyond) > settled.bound;
  settled.way = reached.way;
  return settled;
}

}  // namespace ttf::schedules::synthesis::instants
