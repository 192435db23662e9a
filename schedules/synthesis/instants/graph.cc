#include "schedules/synthesis/instants/graph.h"

#include <algorithm>
#include <set>
#include <utility>

namespace ttf::schedules::synthesis::instants {

Graph::Graph(const Problem& problem) : before(problem.activities.size()), after(problem.activities.size()) {
  std::set<std::pair<std::size_t, std::size_t>> chained;
  for (const Chain& chain : problem.chains)
    for (std::size_t i = 1; i < chain.activities.size(); ++i)
      chained.insert({chain.activities[i - 1], chain.activities[i]});
  for (const bool first : {true, false})
    for (const Precedence& one : problem.precedences) {
      if (chained.contains({one.before, one.after}) != first || leads(one.after, one.before)) continue;
      const Ticks gap = problem.activities[one.before].duration + one.gap;
      after[one.before].push_back({one.after, gap});
      before[one.after].push_back({one.before, gap});
    }
}

bool Graph::leads(std::size_t from, std::size_t to) const {
  if (from == to) return true;
  std::vector<bool> seen(after.size());
  std::vector<std::size_t> left{from};
  while (!left.empty()) {
    const std::size_t at = left.back();
    left.pop_back();
    for (const Edge& edge : after[at]) {
      if (edge.other == to) return true;
      if (!seen[edge.other]) left.push_back(edge.other);
      seen[edge.other] = true;
    }
  }
  return false;
}

}  // namespace ttf::schedules::synthesis::instants
