#include "schedules/synthesis/solver/explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/schedules/synthesis/by_hand/oracle.h"

namespace ttf::schedules::synthesis::solver {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Said = Statement::Kind;

Problem without(const Problem& problem, const Statement& statement) {
  Problem made = problem;
  const auto at = static_cast<std::ptrdiff_t>(statement.index);
  Activity& activity = made.activities[statement.kind == Said::kWindow ? statement.index : 0];
  switch (statement.kind) {
    case Said::kWindow:
      // Offsets count modulo the period, except for precedences, which reach no further in drawn problems.
      activity.window = problem.precedences.empty() ? Window{0, activity.period - 1} : Window{-25, 40};
      activity.grid = {};
      activity.fixed.reset();
      break;
    case Said::kPrecedence: made.precedences.erase(made.precedences.begin() + at); break;
    case Said::kResource:
      for (Activity& own : made.activities)
        if (own.resource == statement.index) own.resource.reset();
      break;
    case Said::kAge: made.chains[statement.index].largest_age.reset(); break;
  }
  return made;
}

// The problem with a core's statements alone.
Problem core_alone(const Problem& problem, const std::vector<Statement>& core) {
  Problem made = problem;
  const auto keeps = [&](Said kind, std::size_t at) { return std::ranges::count(core, Statement{kind, at}) > 0; };
  for (std::size_t at = problem.precedences.size(); at-- > 0;)
    if (!keeps(Said::kPrecedence, at)) made = without(made, {Said::kPrecedence, at});
  for (std::size_t at = 0; at < problem.activities.size(); ++at)
    if (!keeps(Said::kWindow, at)) made = without(made, {Said::kWindow, at});
  for (std::size_t at = 0; at < problem.resources.size(); ++at)
    if (!keeps(Said::kResource, at)) made = without(made, {Said::kResource, at});
  for (std::size_t at = 0; at < problem.chains.size(); ++at)
    if (!keeps(Said::kAge, at)) made = without(made, {Said::kAge, at});
  return made;
}

TEST(SynthesisExplain, NamesTwoTasksThatOneProcessorCannotServe) {
  Problem problem;
  problem.resources = {{"P"}, {"Q"}};
  problem.activities = {
      {"a", 1, 0, 10, 6, {0, 9}, {}, {}}, {"b", 2, 0, 10, 5, {0, 9}, {}, {}}, {"c", 3, 1, 10, 5, {0, 9}, {}, {}}};
  const Explanation explanation = explain(problem);
  EXPECT_THAT(explanation.core, ElementsAre(Statement{Said::kResource, 0}));
  EXPECT_TRUE(explanation.smallest);
  EXPECT_FALSE(explanation.change);
}

TEST(SynthesisExplain, NamesTheAgeThatMustGrowAndToWhat) {
  Problem problem;
  problem.resources = {{"segment"}};
  problem.activities = {{"scan", 1, {}, 20, 3, {0, 0}, {}, {}},
                        {"frame", 2, 0, 20, 2, {0, 39}, {20, 5, 15, 5}, {}},
                        {"other", 3, 0, 20, 2, {0, 39}, {20, 5, 15, 5}, 5},
                        {"fuse", 4, {}, 20, 4, {0, 39}, {}, {}}};
  problem.chains = {{"front", {0, 1, 3}, {}, 15, true, 5}};
  const Explanation explanation = explain(problem);
  // scan 0..3, the slot at 5 is taken, frame 10..12, fuse 12..16.
  EXPECT_THAT(explanation.core,
              ElementsAre(Statement{Said::kWindow, 0}, Statement{Said::kWindow, 1}, Statement{Said::kWindow, 2},
                          Statement{Said::kResource, 0}, Statement{Said::kAge, 0}));
  EXPECT_TRUE(explanation.smallest);
  ASSERT_TRUE(explanation.change);
  EXPECT_EQ(explanation.change->chain, 0u);
  EXPECT_EQ(explanation.change->largest_age, 16);
}

TEST(SynthesisExplain, NamesPrecedencesInACircle) {
  Problem problem;
  problem.activities = {{"a", 1, {}, 10, 3, {0, 9}, {}, {}}, {"b", 2, {}, 10, 3, {0, 9}, {}, {}}};
  problem.precedences = {{0, 1, 0, 2, 3}, {1, 0, 0, 2, 4}};
  EXPECT_THAT(explain(problem).core, ElementsAre(Statement{Said::kPrecedence, 0}, Statement{Said::kPrecedence, 1}));
  problem.precedences.pop_back();
  EXPECT_THAT(explain(problem).core, IsEmpty());
}

TEST(SynthesisExplain, CoresOfDrawnProblemsAreInfeasibleAndSmallest) {
  int explained = 0, changes = 0;
  for (std::uint64_t seed = 0; explained < 200; ++seed) {
    ASSERT_LT(seed, 5000u);
    const Problem problem = by_hand::drawn(seed, true);
    if (problem.activities.size() > 3 || by_hand::feasible(problem)) continue;
    const Explanation explanation = explain(problem);
    ASSERT_FALSE(explanation.core.empty()) << seed;
    EXPECT_TRUE(explanation.smallest) << seed;
    EXPECT_FALSE(by_hand::feasible(core_alone(problem, explanation.core))) << seed;
    for (std::size_t at = 0; at < explanation.core.size(); ++at) {
      std::vector<Statement> fewer = explanation.core;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at));
      EXPECT_TRUE(by_hand::feasible(core_alone(problem, fewer))) << seed << ' ' << at;
    }
    ++explained;
    if (!explanation.change) continue;
    ++changes;
    Problem changed = problem;
    changed.chains[explanation.change->chain].largest_age = explanation.change->largest_age;
    EXPECT_TRUE(by_hand::feasible(changed)) << seed;
    changed.chains[explanation.change->chain].largest_age = explanation.change->largest_age - 1;
    EXPECT_FALSE(by_hand::feasible(changed)) << seed;
  }
  EXPECT_GT(changes, 50);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::solver
