#include "schedules/synthesis/instants/reach.h"

#include <algorithm>

#include "schedules/synthesis/instants/grid.h"

namespace ttf::schedules::synthesis::instants {
namespace {

// Returns how many places of a grid another activity takes at most, wherever it is.
std::size_t most_blocked(const Activity& one, const Grid& grid, const Activity& other, const Grid& others) {
  if (one.duration == 0 || other.duration == 0) return 0;
  const auto steps = [&](Ticks duration) { return (duration + grid.step - 1) / grid.step; };
  const bool alike = grid.period == others.period && grid.first == others.first && grid.step == others.step;
  return static_cast<std::size_t>(alike ? steps(one.duration) + steps(other.duration) - 1
                                        : (one.duration + other.duration - 2) / grid.step + 1);
}

}  // namespace

Reach::Reach(const Reading& reading, const Graph& graph, const std::vector<Grid>& grids, const std::vector<bool>& main,
             std::size_t anchor)
    : reading_(reading), graph_(graph), grids_(grids), main_(main), anchor_(anchor) {}

std::optional<Ticks> Reach::earliest(std::size_t a, const std::vector<std::optional<Ticks>>& by_age) {
  if (a == anchor_) return 0;
  if (const auto known = known_.find(a); known != known_.end()) return known->second;
  std::optional<Ticks> found = by_age[a];
  const auto is_main = [&](const Edge& edge) { return main_[edge.other]; };
  if (const auto& after = graph_.after[a]; std::count_if(after.begin(), after.end(), is_main) == 1) {
    const Edge& taker = *std::find_if(after.begin(), after.end(), is_main);
    const auto behind = earliest(taker.other, by_age);
    if (const auto held = behind ? held_up(a) : std::nullopt)
      found = std::min(found.value_or(*behind + taker.gap + *held), *behind + taker.gap + *held);
  }
  return known_[a] = found;
}

bool Reach::fuses(std::size_t a) const {
  return std::any_of(reading_.fused.begin(), reading_.fused.end(), [&](const Fused& one) { return one.fusing == a; });
}

bool Reach::takes(std::size_t taker, std::size_t from) const {
  const auto& after = graph_.after[from];
  return std::any_of(after.begin(), after.end(), [&](const Edge& edge) { return edge.other == taker; });
}

std::optional<Ticks> Reach::held_up(std::size_t a) const {
  const std::vector<Activity>& all = reading_.problem.activities;
  if (all[a].fixed) return std::nullopt;
  if (!all[a].resource) return 0;
  if (fuses(a)) return among_fusions(a);
  // Takers of fusions' data do not move, and neither do other tasks of their processor: fusions count on them.
  for (std::size_t b = 0; b < all.size(); ++b)
    if (fuses(b) && (all[b].resource == all[a].resource || takes(a, b))) return std::nullopt;
  return among_places(a);
}

std::optional<Ticks> Reach::among_fusions(std::size_t a) const {
  const std::vector<Activity>& all = reading_.problem.activities;
  const Edge& taker = *std::find_if(graph_.after[a].begin(), graph_.after[a].end(),
                                    [&](const Edge& edge) { return main_[edge.other]; });
  const bool beside = all[taker.other].resource == all[a].resource;
  // Behind a gap the taker's last round might be in the way.
  if (grids_[a].step != 1 || (beside && taker.gap > all[a].duration)) return std::nullopt;
  Ticks others = 0;
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (b == a || b == taker.other || all[b].resource != all[a].resource || (!main_[b] && !all[b].fixed)) continue;
    if (!fuses(b) || all[b].fixed || all[b].period != all[a].period || !takes(taker.other, b)) return std::nullopt;
    others += all[b].duration;
  }
  if (all[a].duration + others + (beside ? all[taker.other].duration : 0) >= all[a].period) return std::nullopt;
  return others;
}

std::optional<Ticks> Reach::among_places(std::size_t a) const {
  const std::vector<Activity>& all = reading_.problem.activities;
  const Activity& one = all[a];
  std::vector<std::size_t> standing;
  std::size_t blocked = 0;  // places, at most
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (b == a || !share_a_lane(one, all[b])) continue;
    if (all[b].fixed) standing.push_back(b);
    if (all[b].fixed || !main_[b]) continue;
    if (all[b].period != one.period) return std::nullopt;
    blocked += most_blocked(one, grids_[a], all[b], grids_[b]);
  }
  std::vector<Ticks> free;
  for (Ticks at = next_on_grid(grids_[a], 0); at < one.period; at = next_on_grid(grids_[a], at + 1))
    if (std::none_of(standing.begin(), standing.end(),
                     [&](std::size_t b) { return in_the_way(one, at, all[b], *all[b].fixed, true) != 0; }))
      free.push_back(at);
  if (free.size() <= blocked) return std::nullopt;
  // The latest beginning that the taker allows may be just before a free place.
  Ticks longest = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::size_t next = (i + blocked + 1) % free.size();
    longest = std::max(longest, modulo(free[next] - free[i] - 1, one.period));
  }
  return longest;
}

}  // namespace ttf::schedules::synthesis::instants
