// Oracles for small problems: time lines of every tick, samples followed forwards, all offsets tried. They share no formula with
// the checker or the solver.
#pragma once

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "core/random.h"
#include "schedules/synthesis/problem.h"

namespace ttf::schedules::synthesis::by_hand {

inline Ticks hyperperiod(const Problem& problem) {
  Ticks common = 1;
  for (const Activity& activity : problem.activities) common = std::lcm(common, activity.period);
  return common;
}

// Marks every tick of each lane of a resource over the hyperperiod.
inline bool overlaps(const Problem& problem, const std::vector<Ticks>& offsets) {
  const Ticks common = hyperperiod(problem);
  for (std::size_t resource = 0; resource < problem.resources.size(); ++resource) {
    std::vector<int> busy(static_cast<std::size_t>(common), 0);
    for (std::size_t at = 0; at < offsets.size(); ++at) {
      const Activity& activity = problem.activities[at];
      if (activity.resource != resource) continue;
      for (Ticks begin = offsets[at]; begin < offsets[at] + common; begin += activity.period)
        for (Ticks tick = begin; tick < begin + activity.duration; ++tick) {
          int& mark = busy[static_cast<std::size_t>(((tick % common) + common) % common)];
          if ((mark & activity.lanes) != 0) return true;
          mark |= activity.lanes;
        }
    }
  }
  return false;
}

// Marks the owner of every place in the turns of a resource.
inline bool disowns(const Problem& problem, const std::vector<Ticks>& offsets) {
  for (std::size_t a = 0; a < offsets.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const Activity &one = problem.activities[a], &other = problem.activities[b];
      if (!one.resource || one.resource != other.resource || (one.lanes & other.lanes) == 0) continue;
      if (one.turn == 0 || one.turn != other.turn || one.owner == other.owner) continue;
      for (Ticks tick = offsets[a]; tick < offsets[a] + one.duration; ++tick)
        for (Ticks taken = offsets[b]; taken < offsets[b] + other.duration; ++taken)
          if ((tick - taken) % one.turn == 0) return true;
    }
  return false;
}

// Follows the data of every instance forwards: each instance reads the newest that is ready.
struct Instance {
  Ticks begin, sample;
};
// Returns the instances of the chain's activity `last` over two hyperperiods and more; those from `settled` on have all their data.
struct Followed {
  std::vector<Instance> instances;
  Ticks settled = 0;
};
inline Followed followed(const Problem& problem, const Chain& chain, std::size_t last,
                         const std::vector<Ticks>& offsets) {
  const Ticks common = hyperperiod(problem);
  Ticks reach = 2 * common;  // the same for all chains, so that their instances can be held against each other
  for (std::size_t at = 0; at < offsets.size(); ++at)
    reach += 2 * problem.activities[at].period + std::abs(offsets[at]);
  for (const Chain& each : problem.chains)
    for (const Ticks gap : each.gaps) reach += std::abs(gap);
  std::vector<Instance> before;
  for (std::size_t at = 0; at <= last; ++at) {
    const Activity& activity = problem.activities[chain.activities[at]];
    std::vector<Instance> now;
    Ticks begin = offsets[chain.activities[at]];
    while (begin > -reach) begin -= activity.period;
    for (; begin < 2 * common + reach; begin += activity.period) {
      if (at == 0) now.push_back({begin, begin});
      for (auto from = before.rbegin(); at > 0 && from != before.rend(); ++from) {
        const Activity& sender = problem.activities[chain.activities[at - 1]];
        if (from->begin + sender.duration + (chain.gaps.empty() ? 0 : chain.gaps[at - 1]) > begin) continue;
        now.push_back({begin, from->sample});
        break;
      }
    }
    before = std::move(now);
  }
  return {before, common + reach / 2};
}

inline Ticks age(const Problem& problem, const Chain& chain, const std::vector<Ticks>& offsets) {
  const auto [before, settled] = followed(problem, chain, chain.activities.size() - 1, offsets);
  Ticks oldest = 0;
  const Activity& last = problem.activities[chain.activities.back()];
  for (std::size_t at = 0; at + 1 < before.size(); ++at) {
    if (before[at].begin < settled) continue;
    const Ticks until = chain.reduced ? before[at].begin : before[at + 1].begin;
    oldest = std::max(oldest, until + last.duration - before[at].sample);
  }
  return oldest;
}

inline bool in_order(const Problem& problem, const Order& order, const std::vector<Ticks>& offsets) {
  const Followed first = followed(problem, problem.chains[order.first], order.first_at, offsets);
  const Followed second = followed(problem, problem.chains[order.second], order.second_at, offsets);
  for (const Instance& one : first.instances) {
    if (one.begin < std::max(first.settled, second.settled)) continue;
    for (const Instance& other : second.instances) {
      if (other.begin <= one.begin) continue;
      if (other.sample < one.sample + order.apart) return false;
      break;
    }
  }
  return true;
}

// Whether the precedences among the first `count` activities are kept.
inline bool keeps_precedences(const Problem& problem, const std::vector<Ticks>& offsets, std::size_t count) {
  for (const Precedence& precedence : problem.precedences) {
    if (precedence.before >= count || precedence.after >= count) continue;
    const Ticks end = offsets[precedence.before] + problem.activities[precedence.before].duration;
    const Ticks most = precedence.most.value_or(precedence.gap + problem.activities[precedence.before].period - 1);
    if (offsets[precedence.after] < end + precedence.gap || offsets[precedence.after] > end + most) return false;
  }
  return true;
}

inline bool keeps(const Problem& problem, const std::vector<Ticks>& offsets) {
  if (!keeps_precedences(problem, offsets, offsets.size()) || overlaps(problem, offsets) || disowns(problem, offsets))
    return false;
  for (const Chain& chain : problem.chains)
    if (chain.largest_age && age(problem, chain, offsets) > *chain.largest_age) return false;
  for (const Order& order : problem.orders)
    if (!in_order(problem, order, offsets)) return false;
  return true;
}

// The offsets that window, grid or fixed offset allow.
inline std::vector<Ticks> choices(const Activity& activity) {
  if (activity.fixed) return {*activity.fixed};
  std::vector<Ticks> found;
  for (Ticks offset = activity.window.first; offset <= activity.window.last; ++offset)
    for (Ticks on = activity.grid.first; on <= activity.grid.last; on += activity.grid.step)
      if ((offset - on) % activity.grid.period == 0) found.push_back(offset);
  return found;
}

// Calls `visit` with all offsets that keep the problem.
inline void for_all(const Problem& problem, const std::function<void(const std::vector<Ticks>&)>& visit) {
  std::vector<Ticks> offsets(problem.activities.size(), 0);
  const std::function<void(std::size_t)> place = [&](std::size_t at) {
    if (at == offsets.size()) {
      if (keeps(problem, offsets)) visit(offsets);
      return;
    }
    for (const Ticks offset : choices(problem.activities[at])) {
      offsets[at] = offset;
      place(at + 1);
    }
  };
  place(0);
}

inline bool feasible(const Problem& problem) {
  std::vector<Ticks> offsets(problem.activities.size(), 0);
  const std::function<bool(std::size_t)> place = [&](std::size_t at) {
    if (at == offsets.size()) return keeps(problem, offsets);
    for (const Ticks offset : choices(problem.activities[at])) {
      offsets[at] = offset;
      if (keeps_precedences(problem, offsets, at + 1) && place(at + 1)) return true;
    }
    return false;
  };
  return place(0);
}

// A small problem with all that a problem may have. `harmonic`: periods divide each other. One in three has resources of two lanes, and some
// have places with owners.
inline Problem drawn(std::uint64_t seed, bool harmonic) {
  RandomStream draws({.seed = seed, .purpose = Purpose::kTest});
  const auto one_of = [&](const std::vector<Ticks>& values) {
    return values[static_cast<std::size_t>(draws.integer(0, static_cast<std::int64_t>(values.size()) - 1))];
  };
  Problem problem;
  problem.resources = {{"P"}, {"bus"}};
  const auto count = draws.integer(2, 4);
  for (std::int64_t at = 0; at < count; ++at) {
    Activity activity;
    activity.name = "a" + std::to_string(at);
    activity.line = static_cast<int>(at) + 1;
    activity.period = one_of(harmonic ? std::vector<Ticks>{3, 6, 12} : std::vector<Ticks>{4, 6, 8, 9});
    activity.duration = draws.integer(0, 2);
    if (draws.uniform() < 0.8) activity.resource = static_cast<std::size_t>(draws.integer(0, 1));
    activity.window = {draws.integer(-1, 2), 0};
    activity.window.last = activity.window.first + draws.integer(0, activity.period);
    if (draws.uniform() < 0.3) activity.grid = {3, draws.integer(0, 1), 2, 1 + draws.integer(0, 1)};
    if (draws.uniform() < 0.15) activity.fixed = draws.integer(0, 5);
    problem.activities.push_back(activity);
  }
  for (std::size_t at = 0; at + 1 < problem.activities.size(); ++at) {
    if (problem.activities[at].period != problem.activities[at + 1].period || draws.uniform() < 0.3) continue;
    problem.precedences.push_back({at, at + 1, draws.integer(0, 1), std::nullopt, 20});
    if (draws.uniform() < 0.3) problem.precedences.back().most = problem.precedences.back().gap + draws.integer(0, 2);
  }
  for (std::int64_t chain = draws.integer(0, 2); chain > 0; --chain) {
    Chain made;
    made.name = "c" + std::to_string(chain);
    made.reduced = draws.uniform() < 0.6;
    for (std::size_t at = 0; at < problem.activities.size(); ++at)
      if (draws.uniform() < 0.7) made.activities.push_back(at);
    if (made.activities.empty()) continue;
    if (draws.uniform() < 0.4) std::ranges::reverse(made.activities);
    if (draws.uniform() < 0.4)
      for (std::size_t link = 0; link + 1 < made.activities.size(); ++link) made.gaps.push_back(draws.integer(0, 2));
    if (draws.uniform() < 0.7) made.largest_age = draws.integer(3, 24);
    problem.chains.push_back(made);
  }
  RandomStream lanes({.seed = seed, .purpose = Purpose::kTest, .index = 3});
  for (Activity& activity : problem.activities)
    if (seed % 3 == 0) activity.lanes = static_cast<std::uint8_t>(lanes.integer(1, 3));
  for (Activity& activity : problem.activities)
    if (seed % 5 < 2 && harmonic) {
      activity.turn = 3;
      activity.owner = static_cast<std::size_t>(lanes.integer(0, 1));
    }
  return problem;
}

// One period throughout, and each chain's data in the order of the other's. Some data is there before its activity's end.
inline Problem drawn_in_order(std::uint64_t seed) {
  Problem problem = drawn(seed, true);
  RandomStream draws({.seed = seed, .purpose = Purpose::kTest, .index = 2});
  for (Activity& activity : problem.activities) {
    activity.period = 6;
    activity.window.last = std::min(activity.window.last, activity.window.first + 6);
  }
  for (Chain& chain : problem.chains) {
    chain.gaps.clear();
    for (std::size_t link = 0; link + 1 < chain.activities.size(); ++link)
      chain.gaps.push_back(draws.integer(-problem.activities[chain.activities[link]].duration, 1));
  }
  if (problem.chains.size() < 2) return problem;
  const auto last = [&](std::size_t chain) { return problem.chains[chain].activities.size() - 1; };
  problem.orders = {{0, last(0), 1, last(1), draws.integer(-2, 2)}, {1, last(1), 0, last(0), draws.integer(-2, 2)}};
  return problem;
}

}  // namespace ttf::schedules::synthesis::by_hand
