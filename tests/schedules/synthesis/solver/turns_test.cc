#include "schedules/synthesis/solver/turns.h"

#include <gtest/gtest.h>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/bounds.h"
#include "tests/schedules/synthesis/by_hand/oracle.h"

namespace ttf::schedules::synthesis::solver {
namespace {

constexpr std::int64_t kEnough = 100'000;

// All pairs' bounds by Floyd and Warshall; none if a circle shrinks.
using Table = std::vector<std::vector<Ticks>>;
std::optional<Table> closed(Table most) {
  for (std::size_t over = 0; over < most.size(); ++over)
    for (auto& row : most)
      for (std::size_t to = 0; to < most.size(); ++to) row[to] = std::min(row[to], row[over] + most[over][to]);
  for (std::size_t at = 0; at < most.size(); ++at)
    if (most[at][at] < 0) return std::nullopt;
  return most;
}

TEST(SynthesisDifferences, AreClosedAndGoBack) {
  int impossible = 0, returns = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    RandomStream draws({.seed = seed, .purpose = Purpose::kTest, .index = 3});
    const std::size_t count = static_cast<std::size_t>(draws.integer(2, 7));
    std::vector<Window> windows(count);
    Table most(count + 1, std::vector<Ticks>(count + 1, 0));
    for (std::size_t at = 0; at < count; ++at) {
      windows[at] = {draws.integer(-20, 0), draws.integer(0, 40)};
      most[0][at + 1] = windows[at].last;
      most[at + 1][0] = -windows[at].first;
      for (std::size_t to = 1; to <= count; ++to)
        if (to != at + 1) most[at + 1][to] = 1000;
    }
    Differences differences(windows);
    std::vector<Table> tables = {*closed(most)};
    for (int step = 0; step < 40; ++step) {
      for (std::size_t from = 0; from <= count; ++from)
        for (std::size_t to = 0; to <= count; ++to) ASSERT_EQ(differences.most(from, to), tables.back()[from][to]);
      const auto from = static_cast<std::size_t>(draws.integer(0, static_cast<std::int64_t>(count)));
      const auto to = static_cast<std::size_t>(draws.integer(0, static_cast<std::int64_t>(count)));
      const Ticks bound = draws.integer(-25, 40);
      if (from == to) continue;
      Table next = tables.back();
      next[from][to] = std::min(next[from][to], bound);
      differences.mark();
      const std::optional<Table> expected = closed(next);
      ASSERT_EQ(differences.add_most(from, to, bound), expected.has_value());
      if (expected) tables.push_back(*expected);
      if (!expected) differences.go_back(), ++impossible;
      while (tables.size() > 1 && draws.uniform() < 0.3) differences.go_back(), tables.pop_back(), ++returns;
    }
  }
  EXPECT_GT(impossible, 500);
  EXPECT_GT(returns, 500);
}

// Without any other search: every end is held against all offsets tried.
TEST(SynthesisTurns, AgreeWithAllOffsetsTried) {
  int feasible = 0, infeasible = 0, followed = 0, unharmonic = 0;
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const Problem problem = by_hand::drawn(seed, seed % 4 != 0);
    const bool expected = by_hand::feasible(problem);
    const Model model({problem, {}, {}});
    if (model.contradictory) continue;
    const Rules rules(model);
    Turns turns(rules);
    const Turns::End end = turns.run(kEnough);
    ASSERT_NE(end, Turns::End::kGaveUp) << seed;
    bool harmonic = true;
    for (const ChainTerms& chain : model.chains) {
      if (chain.limit < kNoLimit) harmonic &= chain.harmonic;
      followed += chain.limit < kNoLimit && chain.harmonic && !chain.pairwise;
    }
    ASSERT_TRUE(!expected || end == Turns::End::kFound) << seed;
    if (!harmonic) {
      ++unharmonic;
      continue;
    }
    ASSERT_EQ(end == Turns::End::kFound, expected) << seed;
    ASSERT_TRUE(!expected || by_hand::keeps(problem, turns.found())) << seed;
    (expected ? feasible : infeasible) += 1;
  }
  EXPECT_GT(feasible, 300);
  EXPECT_GT(infeasible, 100);
  EXPECT_GT(followed, 100);
  EXPECT_GT(unharmonic, 100);
}

TEST(SynthesisTurns, KeepSpans) {
  int asked = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Problem problem = by_hand::drawn(seed, true);
    std::vector<std::size_t> all;
    for (std::size_t at = 0; at < problem.activities.size(); ++at) all.push_back(at);
    Ticks least = 1000;
    by_hand::for_all(problem, [&](const std::vector<Ticks>& offsets) {
      Ticks first = 1000, last = -1000;
      for (const std::size_t at : all)
        first = std::min(first, offsets[at]), last = std::max(last, offsets[at] + problem.activities[at].duration);
      least = std::min(least, last - first);
    });
    // A span of less than a duration is no rule about two activities.
    if (least == 1000 || least <= 2) continue;
    ++asked;
    for (const Ticks below : {0, 1}) {
      const Question question{problem, {}, {{all, least - below}}};
      const Model model(question);
      const Rules rules(model);
      EXPECT_EQ(Turns(rules).run(kEnough), below == 0 ? Turns::End::kFound : Turns::End::kExhausted) << seed;
    }
  }
  EXPECT_GT(asked, 60);
}

TEST(SynthesisTurns, TheSameProblemHasTheSameOffsetsAndSplits) {
  const Problem problem = by_hand::drawn(4, true);
  const Model model({problem, {}, {}});
  const Rules rules(model);
  Turns one(rules), two(rules);
  EXPECT_EQ(one.run(kEnough), two.run(kEnough));
  EXPECT_EQ(one.found(), two.found());
  EXPECT_EQ(one.splits(), two.splits());
}

// A folded problem allows all that the problem allows, and two chains forbid only what is impossible.
TEST(SynthesisBounds, FoldedProblemsAndPairsAreRelaxations) {
  int turned = 0, contradictions = 0, possible = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Problem problem = by_hand::drawn(seed, seed % 3 != 0);
    if (seed % 2 == 0)  // so that more of them may turn
      for (Activity& activity : problem.activities)
        activity.fixed.reset(), activity.window.last = activity.window.first + activity.period;
    const bool expected = by_hand::feasible(problem);
    const Problem relaxed = folded(problem);
    for (const Activity& activity : relaxed.activities)
      turned += activity.window.last - activity.window.first < activity.period - 1 && activity.window.first == 0;
    std::int64_t splits = kEnough;
    const bool contradict = two_chains_contradict(problem, splits);
    contradictions += contradict;
    if (!expected) continue;
    ++possible;
    ASSERT_FALSE(contradict) << seed;
    ASSERT_TRUE(by_hand::feasible(relaxed)) << seed;
  }
  EXPECT_GT(turned, 300);
  EXPECT_GT(contradictions, 50);
  EXPECT_GT(possible, 1000);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::solver
