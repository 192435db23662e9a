#include "schedules/synthesis/solver/model.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace ttf::schedules::synthesis::solver {
namespace {

// Ticks behind which nothing of a problem lies.
Ticks most_behind(const Problem& problem, const Precedence& precedence) {
  return precedence.most.value_or(precedence.gap + problem.activities[precedence.before].period - 1);
}

}  // namespace

ChainTerms terms_of(const Problem& problem, const Chain& chain) {
  const auto activity = [&](std::size_t at) -> const Activity& { return problem.activities[chain.activities[at]]; };
  const std::size_t last = chain.activities.size() - 1;
  ChainTerms terms;
  terms.limit = chain.largest_age.value_or(kNoLimit);
  terms.base = activity(last).duration + (chain.reduced ? 0 : activity(last).period);
  Ticks stride = activity(last).period;
  terms.stride.assign(chain.activities.size(), 0);
  terms.stride[last] = stride;
  for (std::size_t at = last; at-- > 0;) {
    const Ticks period = activity(at).period, common = std::gcd(stride, period);
    const Ticks ready = activity(at).duration + (chain.gaps.empty() ? 0 : chain.gaps[at]);
    terms.ready.insert(terms.ready.begin(), ready);
    terms.modulus.insert(terms.modulus.begin(), std::gcd(period, activity(at + 1).period));
    terms.base += ready;
    if (stride > 0) terms.base += period - common;  // 0 where the stride is a multiple
    // Behind periods that do not divide each other, which instances are read follows no one stride.
    terms.harmonic &= stride > 0 && (stride % period == 0 || period % stride == 0);
    terms.pairwise &= terms.harmonic && common == terms.modulus.front();
    terms.stride[at] = stride = terms.harmonic ? std::max(stride, period) : 0;
  }
  return terms;
}

Model::Model(const Question& question) : problem(question.problem), sums(question.sums), spans(question.spans) {
  read_periods();
  read_chains(question);
  read_places();
  contradictory = precedences_contradict();
  if (!contradictory) narrow();
  if (!contradictory) fold();
}

void Model::read_periods() {
  std::map<Ticks, std::size_t> numbers;
  for (const Activity& activity : problem.activities) numbers.emplace(activity.period, 0);
  for (auto& [period, number] : numbers) number = distinct_++;
  for (const Activity& activity : problem.activities) classes_.push_back(numbers.at(activity.period));
  for (const auto& [a, number_a] : numbers)
    for (const auto& [b, number_b] : numbers) divisors_.push_back(std::gcd(a, b));
}

void Model::read_chains(const Question& question) {
  const std::size_t count = problem.activities.size();
  memberships.resize(count);
  sums_of.resize(count);
  spans_of.resize(count);
  for (std::size_t chain = 0; chain < problem.chains.size(); ++chain) {
    chains.push_back(terms_of(problem, problem.chains[chain]));
    const std::vector<std::size_t>& along = problem.chains[chain].activities;
    for (std::size_t at = 0; at < along.size(); ++at) memberships[along[at]].push_back({chain, at});
  }
  for (std::size_t sum = 0; sum < question.sums.size(); ++sum)
    for (const std::size_t chain : question.sums[sum].chains)
      for (const std::size_t activity : problem.chains[chain].activities)
        if (sums_of[activity].empty() || sums_of[activity].back() != sum) sums_of[activity].push_back(sum);
  for (std::size_t span = 0; span < question.spans.size(); ++span)
    for (const std::size_t activity : question.spans[span].activities) spans_of[activity].push_back(span);
}

void Model::read_places() {
  distances.resize(problem.activities.size());
  for (const Activity& activity : problem.activities) {
    windows.push_back(activity.fixed ? Window{*activity.fixed, *activity.fixed} : activity.window);
    grids.push_back(activity.fixed ? Grid{} : activity.grid);
  }
  for (const Precedence& precedence : problem.precedences) {
    const Ticks duration = problem.activities[precedence.before].duration;
    const Ticks least = duration + precedence.gap, most = duration + most_behind(problem, precedence);
    distances[precedence.after].push_back({precedence.before, least, most});
    distances[precedence.before].push_back({precedence.after, -most, -least});
  }
}

// Bellman and Ford: offsets that keep all precedences exist if and only if no circle of them shrinks.
bool Model::precedences_contradict() const {
  std::vector<Ticks> earliest(windows.size(), 0);
  for (std::size_t round = 0; round <= windows.size(); ++round) {
    bool changed = false;
    for (std::size_t at = 0; at < windows.size(); ++at)
      for (const Distance& distance : distances[at]) {
        if (distance.least > distance.most) return true;
        const Ticks bound = earliest[distance.other] + distance.least;
        if (bound > earliest[at]) earliest[at] = bound, changed = true;
      }
    if (!changed) return false;
  }
  return true;
}

void Model::narrow() {
  bool changed = true;
  for (std::size_t round = 0; changed && round < 2 * windows.size() + 8; ++round) {
    changed = false;
    for (std::size_t at = 0; at < windows.size(); ++at) {
      Window window = windows[at];
      for (const Distance& distance : distances[at]) {
        window.first = std::max(window.first, windows[distance.other].first + distance.least);
        window.last = std::min(window.last, windows[distance.other].last + distance.most);
      }
      window = {on_grid_from(at, window.first), on_grid_to(at, window.last)};
      if (window.first > window.last) {
        contradictory = true;
        return;
      }
      changed |= window.first != windows[at].first || window.last != windows[at].last;
      windows[at] = window;
    }
  }
}

// Where no precedence and no span looks at it, an offset counts modulo its period.
void Model::fold() {
  for (std::size_t at = 0; at < windows.size(); ++at) {
    const Ticks period = problem.activities[at].period;
    if (!distances[at].empty() || !spans_of[at].empty() || period % grids[at].period != 0) continue;
    windows[at].last = std::min(windows[at].last, windows[at].first + period - 1);
  }
}

Ticks Model::on_grid_from(std::size_t activity, Ticks offset) const {
  const Grid& grid = grids[activity];
  const Ticks rest = modulo(offset, grid.period);
  if (rest <= grid.first) return offset + grid.first - rest;
  const Ticks up = grid.first + (rest - grid.first + grid.step - 1) / grid.step * grid.step;
  return up <= grid.last ? offset + up - rest : offset + grid.period + grid.first - rest;
}

Ticks Model::on_grid_to(std::size_t activity, Ticks offset) const {
  const Grid& grid = grids[activity];
  const Ticks rest = modulo(offset, grid.period), last = grid.first + (grid.last - grid.first) / grid.step * grid.step;
  if (rest >= last) return offset + last - rest;
  if (rest < grid.first) return offset - grid.period + last - rest;
  return offset - (rest - grid.first) % grid.step;
}

}  // namespace ttf::schedules::synthesis::solver
