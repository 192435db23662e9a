#include <algorithm>
#include <tuple>

#include "schedules/synthesis/solver/tree.h"

namespace ttf::schedules::synthesis::solver {
namespace {

// How many offsets an activity may have, about.
Ticks choices(const Model& model, std::size_t activity) {
  const Window& window = model.windows[activity];
  const Grid& grid = model.grids[activity];
  const Ticks in_a_period = (grid.last - grid.first) / grid.step + 1;
  return ((window.last - window.first) / grid.period + 1) * in_a_period;
}

// A chain that is to be placed as one, or an activity.
struct Unit {
  std::int64_t weight = 0;
  bool single = false;
  Ticks slack = 0;     // a chain's slack, or an activity's period
  Ticks duration = 0;  // an activity's
  std::size_t index = 0;
  auto key() const { return std::tuple(-weight, single, slack, -duration, index); }
};

std::vector<Unit> units_of(const Model& model, std::span<const std::int64_t> weights, bool by_chain) {
  std::vector<char> in_sum(model.chains.size(), 0);
  for (const SumLimit& sum : model.sums)
    for (const std::size_t chain : sum.chains) in_sum[chain] = 1;
  std::vector<Unit> units;
  for (std::size_t chain = 0; by_chain && chain < model.chains.size(); ++chain) {
    const ChainTerms& terms = model.chains[chain];
    if (terms.limit >= kNoLimit && !in_sum[chain]) continue;
    Unit unit{0, false, terms.limit >= kNoLimit ? kNoLimit : terms.limit - terms.base, 0, chain};
    for (const std::size_t activity : model.problem.chains[chain].activities)
      unit.weight = std::max(unit.weight, weights[activity]);
    units.push_back(unit);
  }
  for (std::size_t at = 0; at < weights.size(); ++at) {
    const Activity& activity = model.problem.activities[at];
    if (!activity.fixed) units.push_back({weights[at], true, activity.period, activity.duration, at});
  }
  std::ranges::sort(units, {}, &Unit::key);
  return units;
}

// First what lies on a grid, from the activity with the fewest choices to the chain's end, then back to its beginning; then what
// fits in between. Ages are best known from the end, so it is the last of such activities where that matters.
void place_chain(const Model& model, std::size_t chain, std::vector<char>& placed, std::vector<std::size_t>& order) {
  const std::vector<std::size_t>& along = model.problem.chains[chain].activities;
  std::size_t pivot = 0;
  for (std::size_t at = 0; at < along.size(); ++at) {
    if (placed[along[at]]) {
      pivot = at;
      break;
    }
    const Ticks own = choices(model, along[at]), most = choices(model, along[pivot]);
    if (own < most || (own == most && !model.chains[chain].pairwise)) pivot = at;
  }
  for (const bool on_grid : {true, false}) {
    const auto push = [&](std::size_t at) {
      if (placed[along[at]] || (on_grid && model.grids[along[at]].period == 1)) return;
      placed[along[at]] = 1;
      order.push_back(along[at]);
    };
    for (std::size_t at = pivot; at < along.size(); ++at) push(at);
    for (std::size_t at = pivot; at-- > 0;) push(at);
  }
}

}  // namespace

std::vector<std::size_t> placing_order(const Model& model, std::span<const std::int64_t> weights, bool by_chain) {
  const std::vector<Activity>& all = model.problem.activities;
  std::vector<std::size_t> order;
  std::vector<char> placed(all.size(), 0);
  for (std::size_t at = 0; at < all.size(); ++at)
    if (all[at].fixed) placed[at] = 1, order.push_back(at);
  for (const Unit& unit : units_of(model, weights, by_chain)) {
    if (!unit.single)
      place_chain(model, unit.index, placed, order);
    else if (!placed[unit.index])
      placed[unit.index] = 1, order.push_back(unit.index);
  }
  return order;
}

}  // namespace ttf::schedules::synthesis::solver
