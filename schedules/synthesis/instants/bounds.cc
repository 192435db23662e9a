#include "schedules/synthesis/instants/bounds.h"

#include <algorithm>
#include <map>
#include <optional>

#include "schedules/synthesis/instants/ages.h"

namespace ttf::schedules::synthesis::instants {
namespace {

// Returns by activity the longest way from its beginning to that of `end`; none if no way leads there.
std::vector<std::optional<Ticks>> ways_to(const Graph& graph, std::size_t end) {
  std::vector<std::optional<Ticks>> longest(graph.before.size());
  longest[end] = 0;
  // Each pass settles one more hop; ways have no rings.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < longest.size(); ++a) {
      if (!longest[a]) continue;
      for (const Edge& edge : graph.before[a]) {
        const Ticks way = *longest[a] + edge.gap;
        if (longest[edge.other] && *longest[edge.other] >= way) continue;
        longest[edge.other] = way;
        changed = true;
      }
    }
  }
  return longest;
}

// Returns by activity the age of the data when it begins, on the way of the chain that makes it largest.
std::map<std::size_t, Ticks> heads_of(const Problem& problem, std::size_t end, const std::vector<Ticks>& beyond) {
  std::map<std::size_t, Ticks> heads;
  for (std::size_t c = 0; c < problem.chains.size(); ++c) {
    const Chain& chain = problem.chains[c];
    if (chain.activities.back() != end) continue;
    Ticks head = beyond.empty() ? 0 : beyond[c];
    for (std::size_t i = 0; i < chain.activities.size(); ++i) {
      if (i > 0) head += problem.activities[chain.activities[i - 1]].duration + chain.gaps[i - 1];
      Ticks& known = heads.try_emplace(chain.activities[i], head).first->second;
      known = std::max(known, head);
    }
  }
  return heads;
}

}  // namespace

Ticks jackson(std::vector<Piece> pieces) {
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.tail < b.tail; });
  Ticks now = pieces.empty() ? 0 : pieces.front().tail, worst = 0;
  std::size_t next = 0;
  std::vector<Piece> open;
  while (next < pieces.size() || !open.empty()) {
    if (open.empty()) now = std::max(now, pieces[next].tail);
    while (next < pieces.size() && pieces[next].tail <= now) open.push_back(pieces[next++]);
    const auto oldest =
        std::max_element(open.begin(), open.end(), [](const Piece& a, const Piece& b) { return a.head < b.head; });
    const Ticks spent = next < pieces.size() ? std::min(oldest->duration, pieces[next].tail - now) : oldest->duration;
    now += spent;
    oldest->duration -= spent;
    if (oldest->duration > 0) continue;
    worst = std::max(worst, now + oldest->head);
    open.erase(oldest);
  }
  return worst;
}

Ticks least_worst_age(const Problem& problem, const std::vector<Ticks>& beyond) {
  Placed least;
  least.ages = least_ages(problem);
  Ticks worst = least.worst_age(beyond);
  const Graph graph(problem);
  std::vector<std::size_t> ends;
  for (const Chain& chain : problem.chains)
    if (std::find(ends.begin(), ends.end(), chain.activities.back()) == ends.end())
      ends.push_back(chain.activities.back());
  for (const std::size_t end : ends) {
    const auto tails = ways_to(graph, end);
    std::map<std::pair<std::size_t, std::uint8_t>, std::vector<Piece>> machines;  // each lane of a resource
    for (const auto& [a, head] : heads_of(problem, end, beyond)) {
      const Activity& one = problem.activities[a];
      if (!one.resource || !tails[a] || one.period != problem.activities[end].period) continue;
      for (const std::uint8_t lane : kLanes)
        if ((one.lanes & lane) != 0)
          machines[{*one.resource, lane}].push_back({*tails[a] - one.duration, one.duration, head});
    }
    for (const auto& [lane, pieces] : machines) worst = std::max(worst, jackson(pieces));
  }
  return worst;
}

}  // namespace ttf::schedules::synthesis::instants
