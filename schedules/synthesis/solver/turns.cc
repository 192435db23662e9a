#include "schedules/synthesis/solver/turns.h"

#include <algorithm>

#include "core/random.h"

namespace ttf::schedules::synthesis::solver {
namespace {

// A tight chain's links count as if they had failed so often: they are split first.
constexpr std::int64_t kTightChain = 16;
constexpr std::int64_t kFirstSplits = 200;
// Numbers kept for ways back: 64 MiB of them.
constexpr std::size_t kMostNumbersKept = std::size_t{8} << 20;

Ticks floored(Ticks dividend, Ticks divisor) { return (dividend - modulo(dividend, divisor)) / divisor; }

}  // namespace

Turns::Turns(const Rules& rules)
    : rules_(rules), differences_(rules.windows), weights_(rules.rules.size() + rules.on_grid.size(), 1) {
  for (const Path& path : rules.paths)
    for (std::size_t link = 0; link < path.links.size(); ++link)
      if (path.slack < path.whole[link]) weights_[path.links[link]] = kTightChain;
  sound_ = !rules.contradictory && propagate();
}

Turns::End Turns::run(std::int64_t most_splits) {
  End end = End::kGaveUp;
  std::uint64_t number = 0;
  for (std::int64_t left = most_splits, most = kFirstSplits; end == End::kGaveUp && left > 0; most += most / 4) {
    const std::int64_t before = splits_;
    end = descend(std::min(most, left), number++);
    while (!path_.empty()) differences_.go_back(), path_.pop_back();
    left -= std::max<std::int64_t>(1, splits_ - before);
  }
  return end;
}

// The first time it takes the lower half of each split first; then it draws.
Turns::End Turns::descend(std::int64_t most_splits, std::uint64_t number) {
  RandomStream draws({.seed = number, .purpose = Purpose::kSynthesis, .index = 2});
  bool sound = sound_;
  for (std::int64_t made = 0;;) {
    Split split;
    if (sound && !choose(split)) {
      found_.clear();
      for (std::size_t at = 0; at < rules_.model.windows.size(); ++at) found_.push_back(differences_.least(0, at + 1));
      return End::kFound;
    }
    if (sound) {
      if (made++ >= most_splits || differences_.kept() > kMostNumbersKept) return End::kGaveUp;
      ++splits_;
      split.lower_first = number == 0 || draws.bits() % 2 == 0;
      differences_.mark();
      path_.push_back(split);
      sound = apply(split, split.lower_first) && propagate();
      continue;
    }
    if (path_.empty()) return End::kExhausted;
    differences_.go_back();
    split = path_.back();
    path_.pop_back();
    sound = apply(split, !split.lower_first) && propagate();
  }
}

// A grid is split between two of its places.
bool Turns::choose(Split& split) const {
  double best = 0;
  const auto better = [&](Ticks choices, std::size_t rule) {
    const double worth = static_cast<double>(weights_[rule]) / static_cast<double>(choices);
    if (worth <= best) return false;
    best = worth;
    return true;
  };
  for (std::size_t rule = 0; rule < rules_.rules.size(); ++rule) {
    const Rule& own = rules_.rules[rule];
    const auto [first, last] = turns(own);
    if (first >= last || !better(last - first, rule)) continue;
    const Ticks middle = first + (last - first - 1) / 2;
    split = {rule, own.from, own.to, own.most + own.unit * middle, own.least + own.unit * (middle + 1), true};
  }
  for (std::size_t grid = 0; grid < rules_.on_grid.size(); ++grid) {
    const std::size_t at = rules_.on_grid[grid], rule = rules_.rules.size() + grid;
    const Ticks first = differences_.least(0, at + 1), last = differences_.most(0, at + 1);
    const Ticks steps = std::max<Ticks>(1, (last - first) / rules_.model.grids[at].step);
    if (first >= last || !better(steps, rule)) continue;
    const Ticks middle = rules_.model.on_grid_to(at, first + (last - first - 1) / 2);
    split = {rule, 0, at + 1, middle, rules_.model.on_grid_from(at, middle + 1), true};
  }
  return best > 0;
}

bool Turns::fails(std::size_t rule) {
  ++weights_[rule];
  return false;
}

bool Turns::apply(const Split& split, bool lower) {
  const bool sound = lower ? differences_.add_most(split.from, split.to, split.most)
                           : differences_.add_least(split.from, split.to, split.least);
  return sound || fails(split.rule);
}

bool Turns::propagate() {
  for (std::size_t changes = differences_.changes() + 1; changes != differences_.changes();) {
    changes = differences_.changes();
    if (!round_to_grids()) return false;
    for (const Path& path : rules_.paths)
      if (!limit_rests(path)) return false;
    for (std::size_t rule = 0; rule < rules_.rules.size(); ++rule)
      if (!bind(rules_.rules[rule])) return fails(rule);
  }
  return true;
}

bool Turns::round_to_grids() {
  for (std::size_t grid = 0; grid < rules_.on_grid.size(); ++grid) {
    const std::size_t at = rules_.on_grid[grid];
    const Ticks first = rules_.model.on_grid_from(at, differences_.least(0, at + 1));
    const Ticks last = rules_.model.on_grid_to(at, differences_.most(0, at + 1));
    if (!differences_.add_least(0, at + 1, first) || !differences_.add_most(0, at + 1, last))
      return fails(rules_.rules.size() + grid);
  }
  return true;
}

Turns::Range Turns::turns(const Rule& rule) const {
  return {-floored(rule.most - differences_.least(rule.from, rule.to), rule.unit),
          floored(differences_.most(rule.from, rule.to) - rule.least, rule.unit)};
}

// The outer turns bound the difference. A single one binds it.
bool Turns::bind(const Rule& rule) {
  const auto [first, last] = turns(rule);
  return first <= last && differences_.add_least(rule.from, rule.to, rule.least + rule.unit * first) &&
         differences_.add_most(rule.from, rule.to, rule.most + rule.unit * last);
}

// The least sum of rests between two places: a difference if all turns between them are known, else its remainder.
Ticks Turns::least_rest(const Path& path, std::size_t first, std::size_t last) const {
  const std::size_t from = path.numbers[first], to = path.numbers[last];
  const Ticks ready = path.ready[last] - path.ready[first], unit = path.unit(first, last);
  const Ticks least = differences_.least(from, to) - ready, most = differences_.most(from, to) - ready;
  Ticks turned = 0;
  for (std::size_t link = first; link < last; ++link) {
    const auto [lowest, highest] = turns(rules_.rules[path.links[link]]);
    if (lowest < highest) {
      const Ticks rest = modulo(least, unit);
      return rest + most - least < unit ? rest : 0;
    }
    turned += lowest * rules_.rules[path.links[link]].unit;
  }
  return std::max<Ticks>(0, least - turned);
}

// Between two places, rests have what the rests before and behind leave of the slack.
bool Turns::limit_rests(const Path& path) {
  const std::size_t count = path.numbers.size();
  std::vector<Ticks> before(count, 0), behind(count, 0);
  for (std::size_t last = 1; last < count; ++last)
    for (std::size_t first = 0; first < last; ++first) {
      const Ticks rest = least_rest(path, first, last);
      before[last] = std::max(before[last], before[first] + rest);
    }
  for (std::size_t first = count - 1; first-- > 0;)
    for (std::size_t last = first + 1; last < count; ++last)
      behind[first] = std::max(behind[first], least_rest(path, first, last) + behind[last]);
  if (before[count - 1] > path.slack) {
    for (const std::size_t link : path.links) ++weights_[link];
    return false;
  }
  for (std::size_t first = 0; first + 1 < count; ++first) {
    Ticks turned = 0;
    bool known = true;
    for (std::size_t last = first + 1; last < count; ++last) {
      const Rule& link = rules_.rules[path.links[last - 1]];
      const auto [lowest, highest] = turns(link);
      known &= lowest == highest;
      turned += lowest * link.unit;
      const Ticks most = path.slack - before[first] - behind[last], ready = path.ready[last] - path.ready[first];
      const Ticks unit = path.unit(first, last);
      const std::size_t from = path.numbers[first], to = path.numbers[last];
      const bool kept = known ? differences_.add_most(from, to, ready + turned + most)
                              : most >= unit - 1 || bind({from, to, unit, ready, ready + most});
      if (!kept) return fails(path.links[last - 1]);
    }
  }
  return true;
}

}  // namespace ttf::schedules::synthesis::solver
