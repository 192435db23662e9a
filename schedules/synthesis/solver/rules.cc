#include "schedules/synthesis/solver/rules.h"

#include <numeric>

namespace ttf::schedules::synthesis::solver {
namespace {

constexpr Ticks kNoTurn = kNoLimit;  // a unit that no difference reaches

}  // namespace

Rules::Rules(const Model& question) : model(question), windows(question.windows) {
  add_places();
  add_resources();
  for (std::size_t chain = 0; chain < model.chains.size(); ++chain)
    if (model.chains[chain].limit < kNoLimit) add_path(chain);
  add_spans();
}

void Rules::add_places() {
  for (std::size_t at = 0; at < model.grids.size(); ++at) {
    const Grid& grid = model.grids[at];
    if (grid.last - grid.first < grid.period - 1) rules.push_back({0, at + 1, grid.period, grid.first, grid.last});
    if (grid.step > 1) on_grid.push_back(at);
  }
  for (std::size_t at = 0; at < model.distances.size(); ++at)
    for (const Distance& distance : model.distances[at])
      if (distance.least >= 0) rules.push_back({distance.other + 1, at + 1, kNoTurn, distance.least, distance.most});
}

void Rules::add_resources() {
  const std::vector<Activity>& all = model.problem.activities;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      if (!share_a_lane(all[a], all[b]) || all[a].duration == 0 || all[b].duration == 0) continue;
      const Ticks common = meeting_time(all[a], all[b]);
      rules.push_back({a + 1, b + 1, common, all[a].duration, common - all[b].duration});
      contradictory |= all[a].duration + all[b].duration > common;
    }
}

void Rules::add_path(std::size_t chain) {
  const ChainTerms& terms = model.chains[chain];
  const std::vector<std::size_t>& along = model.problem.chains[chain].activities;
  const auto period = [&](std::size_t at) { return model.problem.activities[along[at]].period; };
  const bool followed = terms.harmonic && !terms.pairwise;
  Path path;
  path.slack = terms.limit - terms.base;
  contradictory |= path.slack < 0;
  path.units.assign(along.size() * along.size(), 0);
  for (const std::size_t activity : along) path.numbers.push_back(activity + 1);
  for (std::size_t at = 0; at < along.size(); ++at) {
    path.ready.push_back(at == 0 ? 0 : path.ready[at - 1] + terms.ready[at - 1]);
    if (followed && terms.stride[at] > period(at)) {
      windows.push_back({0, terms.stride[at] - 1});
      path.numbers[at] = windows.size();
      rules.push_back({along[at] + 1, windows.size(), period(at), 0, 0});
    }
    Ticks links = 0;
    for (std::size_t before = at; before-- > 0;) {
      links = std::gcd(links, terms.modulus[before]);
      const Ticks ends = std::gcd(period(before), period(at));
      path.units[before * along.size() + at] = followed ? terms.stride[at] : terms.harmonic ? ends : links;
    }
    if (at == 0) continue;
    path.whole.push_back(followed ? std::gcd(terms.stride[at], period(at - 1)) : terms.modulus[at - 1]);
    path.links.push_back(rules.size());
    const Ticks ready = terms.ready[at - 1];
    rules.push_back(
        {path.numbers[at - 1], path.numbers[at], path.unit(at - 1, at), ready, ready + path.whole.back() - 1});
  }
  paths.push_back(std::move(path));
}

// No end is more than so much behind a beginning.
void Rules::add_spans() {
  const std::vector<Activity>& all = model.problem.activities;
  for (const SpanLimit& span : model.spans)
    for (const std::size_t a : span.activities)
      for (const std::size_t b : span.activities)
        if (a < b) rules.push_back({a + 1, b + 1, kNoTurn, all[a].duration - span.most, span.most - all[b].duration});
}

}  // namespace ttf::schedules::synthesis::solver
