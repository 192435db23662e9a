#include "schedules/synthesis/instants/ages.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "schedules/synthesis/instants/grid.h"

namespace ttf::schedules::synthesis::instants {

Ticks Placed::worst_age(const std::vector<Ticks>& beyond) const {
  Ticks worst = 0;
  for (std::size_t c = 0; c < ages.size(); ++c) worst = std::max(worst, ages[c] + (beyond.empty() ? 0 : beyond[c]));
  return worst;
}
Ticks Placed::jitter() const {
  Ticks most = 0;
  for (std::size_t c = 0; c < ages.size(); ++c) most = std::max(most, ages[c] - least[c]);
  return most;
}
Ticks Placed::sum_of_ages() const { return std::accumulate(ages.begin(), ages.end(), Ticks{0}); }

Ticks limit_of(const Problem& problem, const Limits& limits, std::size_t chain) {
  constexpr Ticks kNone = std::numeric_limits<Ticks>::max();
  const Ticks beyond = limits.beyond.empty() ? 0 : limits.beyond[chain];
  return std::min({problem.chains[chain].largest_age.value_or(kNone),
                   limits.largest_ages.empty() ? kNone : limits.largest_ages[chain],
                   limits.worst_age ? *limits.worst_age - beyond : kNone});
}

std::vector<Ticks> least_ages(const Problem& problem) {
  std::vector<Ticks> least;
  for (const Chain& chain : problem.chains) {
    Ticks sum = 0;
    for (std::size_t i = 1; i < chain.activities.size(); ++i)
      sum += problem.activities[chain.activities[i - 1]].duration + chain.gaps[i - 1];
    least.push_back(sum);
  }
  return least;
}

Ticks read_at(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets, Ticks start) {
  Ticks at = start;
  for (std::size_t i = 1; i < chain.activities.size(); ++i) {
    const std::size_t a = chain.activities[i];
    at += problem.activities[chain.activities[i - 1]].duration + chain.gaps[i - 1];
    at += modulo(offsets[a] - at, problem.activities[a].period);
  }
  return at;
}

Ways ways(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets) {
  Ticks round = 1;
  for (const std::size_t a : chain.activities) round = std::lcm(round, problem.activities[a].period);
  Ways found{std::numeric_limits<Ticks>::min(), std::numeric_limits<Ticks>::max()};
  const std::size_t first = chain.activities.front();
  for (Ticks start = offsets[first]; start < offsets[first] + round; start += problem.activities[first].period) {
    const Ticks at = read_at(problem, chain, offsets, start);
    found.longest = std::max(found.longest, at - start);
    found.shortest = std::min(found.shortest, at - start);
  }
  return found;
}

}  // namespace ttf::schedules::synthesis::instants
