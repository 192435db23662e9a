// The placement against an exhaustion over all offsets, on drawn problems that are small enough for it.
#include "schedules/synthesis/instants/placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "core/random.h"
#include "schedules/synthesis/instants/bounds.h"
#include "schedules/synthesis/instants/grid.h"

namespace ttf::schedules::synthesis::instants {
namespace {

constexpr Ticks kCycle = 24;

// Two sensors share a segment and a processor. Each has measure -> list -> fuse -> image -> use.
Reading drawn(int seed) {
  RandomStream random(StreamKey{.seed = static_cast<std::uint64_t>(seed)});
  const auto within = [&](Ticks low, Ticks high) {
    return low + static_cast<Ticks>(random.uniform() * static_cast<double>(high - low + 1));
  };
  Reading reading;
  Problem& problem = reading.problem;
  problem.resources = {{"segment"}, {"processor"}};
  const auto add = [&](std::optional<std::size_t> resource, Ticks duration, Grid grid) {
    problem.activities.push_back({"", resource, kCycle, duration, grid, std::nullopt});
    if (resource == std::size_t{0} && seed % 3 == 0)  // channels: lists that are on both, or on one
      problem.activities.back().lanes = static_cast<std::uint8_t>(1 + (seed / 3 + problem.activities.size()) % 3);
    return problem.activities.size() - 1;
  };
  const auto follow = [&](std::size_t before, std::size_t after, Ticks gap) {
    problem.precedences.push_back({before, after, gap});
    return gap;
  };
  const int sensors = 2;
  const std::size_t image = add(0, 2, {kCycle, 0, 14, 2}), use = add(std::nullopt, 0, {});
  const Ticks to_use = follow(image, use, within(0, 1));
  for (int s = 0; s < sensors; ++s) {
    const Ticks length = 2 * within(1, 2);
    const std::size_t measured = add(std::nullopt, 0, {}), list = add(0, length, {kCycle, 0, 16 - length, 2}),
                      fuse = add(1, within(2, 5), {});
    Chain chain;
    chain.activities = {measured, list, fuse, image, use};
    chain.gaps = {follow(measured, list, within(1, 6)), follow(list, fuse, within(0, 2)),
                  follow(fuse, image, within(0, 2)), to_use};
    problem.chains.push_back(chain);
  }
  return reading;
}

bool apart(const Problem& problem, const std::vector<Ticks>& offsets) {
  for (std::size_t a = 0; a < offsets.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const Activity &one = problem.activities[a], &other = problem.activities[b];
      if (one.resource && one.resource == other.resource && (one.lanes & other.lanes) != 0 &&
          in_the_way(one, offsets[a], other, offsets[b], true) != 0)
        return false;
    }
  return true;
}

// Returns the least largest age over all offsets of lists, tasks and the image; the rest follows as near as may be.
Ticks exhausted(const Reading& reading) {
  const Problem& problem = reading.problem;
  Ticks best = std::numeric_limits<Ticks>::max();
  std::vector<Ticks> offsets(problem.activities.size());
  std::vector<std::size_t> moving;
  for (std::size_t a = 0; a < offsets.size(); ++a)
    if (problem.activities[a].resource) moving.push_back(a);
  std::vector<std::size_t> index(moving.size());
  const auto choices = [&](std::size_t a) {
    std::vector<Ticks> all;
    for (Ticks at = 0; at < kCycle; ++at)
      if (latest_on_grid(problem.activities[a].grid, at) == at) all.push_back(at);
    return all;
  };
  std::vector<std::vector<Ticks>> allowed;
  for (const std::size_t a : moving) allowed.push_back(choices(a));
  const auto age_of = [&](const Chain& chain) {
    // From the sensor, which is free, as late as its list allows; to the use, which is as early as may be.
    const Ticks start = offsets[chain.activities[1]];
    Ticks at = start;
    for (std::size_t i = 2; i + 1 < chain.activities.size(); ++i) {
      at += problem.activities[chain.activities[i - 1]].duration + chain.gaps[i - 1];
      at += modulo(offsets[chain.activities[i]] - at, kCycle);
    }
    return problem.activities[chain.activities[0]].duration + chain.gaps[0] + at - start +
           problem.activities[chain.activities[3]].duration + chain.gaps[3];
  };
  // `oldest`: of the chains that stand. A chain stands with its task: image and list come before it.
  const auto descend = [&](const auto& self, std::size_t depth, Ticks oldest) -> void {
    if (oldest >= best) return;
    if (depth == moving.size()) {
      best = oldest;
      return;
    }
    for (const Ticks at : allowed[depth]) {
      offsets[moving[depth]] = at;
      bool free = true;
      for (std::size_t d = 0; d < depth && free; ++d) {
        const Activity &one = problem.activities[moving[depth]], &other = problem.activities[moving[d]];
        free = one.resource != other.resource || (one.lanes & other.lanes) == 0 ||
               in_the_way(one, at, other, offsets[moving[d]], true) == 0;
      }
      if (!free) continue;
      Ticks older = oldest;
      for (const Chain& chain : problem.chains)
        if (chain.activities[2] == moving[depth]) older = std::max(older, age_of(chain));
      self(self, depth + 1, older);
    }
  };
  descend(descend, 0, 0);
  return best;
}

TEST(Placement, IsNeverBetterThanExhaustionAndExactWhereItSaysSo) {
  int exact = 0;
  for (int seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Reading reading = drawn(seed);
    const Search found = place(reading, {});
    const Ticks best = exhausted(reading);
    ASSERT_TRUE(found.best);
    EXPECT_TRUE(apart(reading.problem, found.best->solution.offsets));
    EXPECT_GE(found.best->worst_age({}), best);
    EXPECT_LE(least_worst_age(reading.problem, {}), best);
    if (!found.exact) continue;
    ++exact;
    EXPECT_EQ(found.best->worst_age({}), best);
  }
  EXPECT_GT(exact, 20);
}

// A limit one tick below the best leaves nothing, and a limit at the best leaves it.
TEST(Placement, LimitsAreKept) {
  for (int seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Reading reading = drawn(seed);
    const Search free = place(reading, {});
    Limits limits;
    limits.worst_age = free.best->worst_age({});
    EXPECT_TRUE(place(reading, limits, true).best);
    --*limits.worst_age;
    EXPECT_FALSE(free.exact && place(reading, limits).best);
  }
}

// Two pieces of 5 may end at the use. Their heads are 10 and 8. The younger one stands first.
TEST(Bounds, JacksonsScheduleByHand) {
  EXPECT_EQ(jackson({{0, 5, 10}, {0, 5, 8}}), 18);
  EXPECT_EQ(jackson({{0, 5, 10}, {0, 5, 4}}), 15);
  // The second may only end 2 before the use, and is the oldest: it interrupts the first.
  EXPECT_EQ(jackson({{0, 5, 0}, {2, 4, 20}}), 26);
  // The use itself ends behind its beginning, where ages end: that makes no age larger.
  EXPECT_EQ(jackson({{-7, 7, 30}}), 30);
}

TEST(Grid, PositionsAndConflictsByHand) {
  const Grid slots{100, 10, 50, 10};
  EXPECT_EQ(latest_on_grid(slots, 57), 50);
  EXPECT_EQ(latest_on_grid(slots, 105), 50);
  EXPECT_EQ(latest_on_grid(slots, 129), 120);
  EXPECT_EQ(next_on_grid(slots, 51), 110);
  EXPECT_EQ(next_on_grid(slots, -5), 10);
  EXPECT_EQ(next_on_grid(slots, 11), 20);
  const Activity often{"", 0, 50, 10, {}, std::nullopt}, seldom{"", 0, 200, 20, {}, std::nullopt};
  EXPECT_EQ(in_the_way(seldom, 60, often, 0, true), 0);
  EXPECT_EQ(in_the_way(seldom, 105, often, 0, true), 25);  // ends at 100, where the other begins
  EXPECT_EQ(in_the_way(seldom, 105, often, 0, false), 5);  // begins at 110, where the other ends
  EXPECT_EQ(in_the_way(seldom, 90, often, 0, true), 10);
  EXPECT_EQ(in_the_way(seldom, 90, often, 0, false), 20);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::instants
