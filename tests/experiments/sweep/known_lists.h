// The lists that strategies have fused at each instant, and the expected errors at every use.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "core/check.h"
#include "core/ids.h"
#include "core/time.h"
#include "experiments/sweep/expected_error.h"
#include "fusion/strategies/strategy.h"

namespace ttf::experiments::sweep {

// A list on its way, and when a strategy lets it in.
struct ListTimes {
  SensorId sensor{};
  GlobalTime measured{}, arrival{};
};
// The instant of fusion by list, if fusion can happen at any instant and all lists arrive. ADVA fuses on
// arrival. TT fuses when all earlier-measured lists have arrived, since the schedule lists them. BUFF also
// needs, for every other sensor, a list that is not older, or the certainty that none can come. `longest`: by
// sensor, a list's longest way.
inline std::vector<GlobalTime> fused_at(fusion::strategies::StrategyKind strategy, std::span<const ListTimes> lists,
                                        std::span<const Duration> longest) {
  // Each list alone, then behind all older ones.
  const auto certain = [&](const ListTimes& list) {
    GlobalTime at = list.arrival;
    if (strategy != fusion::strategies::StrategyKind::kBuff) return at;
    for (std::size_t s = 0; s < longest.size(); ++s) {
      if (s == index_of(list.sensor)) continue;
      GlobalTime there = list.measured + longest[s];
      for (const ListTimes& other : lists)
        if (index_of(other.sensor) == s && other.measured >= list.measured) there = std::min(there, other.arrival);
      at = std::max(at, there);
    }
    return at;
  };
  std::vector<GlobalTime> fused;
  for (const ListTimes& list : lists) fused.push_back(certain(list));
  if (strategy == fusion::strategies::StrategyKind::kAdva) return fused;
  std::vector<std::size_t> order(lists.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lists[a].measured < lists[b].measured; });
  for (std::size_t i = 1; i < order.size(); ++i) fused[order[i]] = std::max(fused[order[i]], fused[order[i - 1]]);
  return fused;
}

// The image shows everything known at `known`, and is of the instant `at`.
struct Use {
  GlobalTime known{}, at{};
};
// One for every use; both are in order of their instants. `fused[i]` is the instant at which looks[i] is
// fused. Does not throw. Looks must not be newer than the uses that rest on them, and every use must rest on one.
inline std::vector<Eigen::Matrix4d> expected_errors(const PointMotion& motion, std::span<const Look> looks,
                                                    std::span<const GlobalTime> fused, std::span<const Use> uses) {
  TTF_CHECK(looks.size() == fused.size(), "{} looks, {} instants", looks.size(), fused.size());
  std::vector<std::size_t> order(looks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return fused[a] < fused[b]; });
  ErrorRecursion recursion(motion);
  std::vector<Eigen::Matrix4d> errors;
  auto next = order.begin();
  for (const Use& use : uses) {
    for (; next != order.end() && fused[*next] <= use.known; ++next) recursion.fuse(looks[*next]);
    errors.push_back(recursion.at(use.at));
  }
  return errors;
}

}  // namespace ttf::experiments::sweep
