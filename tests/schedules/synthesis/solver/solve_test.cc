#include "schedules/synthesis/solver/solve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/generator.h"
#include "schedules/synthesis/smt/z3_prover.h"
#include "tests/schedules/synthesis/by_hand/oracle.h"

namespace ttf::schedules::synthesis::solver {
namespace {

using testing::IsEmpty;
using Of = Objective::Kind;

Objective least(Of kind, std::vector<std::size_t> which = {}) {
  Objective objective;
  objective.kind = kind;
  objective.which = std::move(which);
  return objective;
}

// The values of all objectives, by hand.
struct Values {
  Ticks largest = 0, sum = 0, lateness = -1000, span = 0;
};

Values values_of(const Problem& problem, const std::vector<Ticks>& offsets) {
  Values values;
  bool any_limit = false;
  for (const Chain& chain : problem.chains) {
    const Ticks age = by_hand::age(problem, chain, offsets);
    values.largest = std::max(values.largest, age);
    values.sum += age;
    if (chain.largest_age) values.lateness = std::max(values.lateness, age - *chain.largest_age), any_limit = true;
  }
  if (!any_limit) values.lateness = 0;
  Ticks first = 1000, last = -1000;
  for (std::size_t at = 0; at < offsets.size(); ++at)
    first = std::min(first, offsets[at]), last = std::max(last, offsets[at] + problem.activities[at].duration);
  values.span = last - first;
  return values;
}

TEST(SynthesisSolve, LeastValuesAreThoseOfAllOffsetsTried) {
  int solved = 0, infeasible = 0;
  for (std::uint64_t seed = 0; seed < 250; ++seed) {
    const Problem problem = by_hand::drawn(seed, seed % 2 == 0);
    if (problem.chains.empty()) continue;
    Values best{1000, 1000, 1000, 1000};
    std::tuple<Ticks, Ticks, Ticks> in_order{1000, 1000, 1000};
    by_hand::for_all(problem, [&](const std::vector<Ticks>& offsets) {
      const Values values = values_of(problem, offsets);
      best = {std::min(best.largest, values.largest), std::min(best.sum, values.sum),
              std::min(best.lateness, values.lateness), std::min(best.span, values.span)};
      in_order = std::min(in_order, std::tuple(values.largest, values.sum, values.span));
    });
    for (const auto& [kind, expected] : {std::pair(Of::kLargestAge, best.largest),
                                         {Of::kSumOfAges, best.sum},
                                         {Of::kLateness, best.lateness},
                                         {Of::kSpan, best.span}}) {
      const Objective objective = least(kind);
      const Outcome outcome = solve(problem, {&objective, 1});
      ASSERT_EQ(outcome.solution.has_value(), expected < 1000) << seed;
      EXPECT_EQ(outcome.proven_infeasible, expected == 1000) << seed;
      if (!outcome.solution) continue;
      EXPECT_TRUE(by_hand::keeps(problem, outcome.solution->offsets)) << seed;
      EXPECT_EQ(outcome.reached[0].value, static_cast<double>(expected)) << seed << ' ' << static_cast<int>(kind);
      EXPECT_TRUE(outcome.reached[0].proven) << seed << ' ' << static_cast<int>(kind);
    }
    const std::vector<Objective> objectives = {least(Of::kLargestAge), least(Of::kSumOfAges), least(Of::kSpan)};
    const Outcome outcome = solve(problem, objectives);
    if (!outcome.solution) {
      ++infeasible;
      continue;
    }
    ++solved;
    const Values values = values_of(problem, outcome.solution->offsets);
    EXPECT_EQ(std::tuple(values.largest, values.sum, values.span), in_order) << seed;
  }
  EXPECT_GT(solved, 80);
  EXPECT_GT(infeasible, 30);
}

TEST(SynthesisSolve, WeightsAndNamedChainsCount) {
  // Both readers want the slot at once; who weighs more has it.
  Problem problem;
  problem.resources = {{"bus"}};
  for (const char* name : {"a", "b"}) {
    problem.activities.push_back({std::string("sense ") + name, 0, {}, 20, 1, {0, 0}, {}, {}});
    problem.activities.push_back({std::string("send ") + name, 0, 0, 20, 4, {0, 19}, {}, {}});
  }
  problem.chains = {{"a", {0, 1}, {}, {}, true, 0}, {"b", {2, 3}, {}, {}, true, 0}};
  Objective weighted = least(Of::kLargestAge);
  weighted.weights = {1, 3};
  Outcome outcome = solve(problem, {&weighted, 1});
  EXPECT_EQ(ages(problem, *outcome.solution), (std::vector<Ticks>{9, 5}));
  EXPECT_EQ(outcome.reached[0].value, 15);
  const std::vector<Objective> named = {least(Of::kLargestAge, {0}), least(Of::kLargestAge, {1})};
  outcome = solve(problem, named);
  EXPECT_EQ(ages(problem, *outcome.solution), (std::vector<Ticks>{5, 9}));
}

TEST(SynthesisSolve, WhatIsFixedStays) {
  Problem problem = generated({.tasks = 12, .messages = 12, .seed = 2});
  const Objective objective = least(Of::kLargestAge);
  const Outcome before = solve(problem, {&objective, 1});
  ASSERT_TRUE(before.solution);
  for (std::size_t at = 0; at < problem.activities.size(); at += 2)
    problem.activities[at].fixed = before.solution->offsets[at];
  const Outcome after = solve(problem, {&objective, 1});
  ASSERT_TRUE(after.solution);
  EXPECT_THAT(violations(problem, *after.solution), IsEmpty());
  for (std::size_t at = 0; at < problem.activities.size(); at += 2)
    EXPECT_EQ(after.solution->offsets[at], before.solution->offsets[at]);
  EXPECT_EQ(after.reached[0].value, before.reached[0].value);
}

TEST(SynthesisSolve, GeneratedProblemsHaveTheSameAnswerTwice) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Problem problem = generated({.seed = seed});
    const std::vector<Objective> objectives = {least(Of::kLargestAge), least(Of::kSumOfAges)};
    const Effort effort{.steps = 1000, .exhaustion = 1000};
    const Outcome one = solve(problem, objectives, effort), two = solve(problem, objectives, effort);
    ASSERT_TRUE(one.solution);
    EXPECT_EQ(one.solution->offsets, two.solution->offsets);
    EXPECT_THAT(violations(problem, *one.solution), IsEmpty());
    for (const Reached& reached : one.reached) EXPECT_LE(reached.bound, reached.value);
    EXPECT_EQ(one.reached[0].value, static_cast<double>(std::ranges::max(ages(problem, *one.solution))));
  }
}

// The bounds of each hold for the other's values.
TEST(SynthesisSolve, SearchAndProverAgreeOnGeneratedProblems) {
  if (!smt::Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Problem problem = generated({.tasks = 8, .messages = 8, .seed = seed});
    const Objective objective = least(Of::kLargestAge);
    smt::Z3Prover prover;
    const Outcome searched = solve(problem, {&objective, 1}), proven = solve(problem, {&objective, 1}, {}, &prover);
    ASSERT_TRUE(searched.solution && proven.solution);
    EXPECT_LE(searched.reached[0].bound, proven.reached[0].value) << seed;
    EXPECT_LE(proven.reached[0].bound, searched.reached[0].value) << seed;
    const bool both = searched.reached[0].proven && proven.reached[0].proven;
    EXPECT_TRUE(!both || searched.reached[0].value == proven.reached[0].value) << seed;
  }
}

// Two equal sensors whose variance grows between samples: it is least when they alternate evenly.
TEST(SynthesisSolve, AFunctionOfOffsetsIsLeastOnTheRaster) {
  Problem problem;
  problem.resources = {{"bus"}};
  for (const char* name : {"first", "second"}) problem.activities.push_back({name, 0, 0, 100, 10, {0, 99}, {}, {}});
  problem.activities[0].fixed = 20;
  Objective objective = least(Of::kFunction);
  objective.moving = {1};
  objective.raster = 5;
  // The integral of the time since the last sample, twice.
  objective.function = [](std::span<const Ticks> offsets) {
    const double apart = static_cast<double>(((offsets[1] - offsets[0]) % 100 + 100) % 100);
    return apart * apart + (100 - apart) * (100 - apart);
  };
  Outcome outcome = solve(problem, {&objective, 1});
  ASSERT_TRUE(outcome.solution);
  EXPECT_EQ(outcome.solution->offsets, (std::vector<Ticks>{20, 70}));
  EXPECT_EQ(outcome.reached[0].value, 5000);
  EXPECT_TRUE(outcome.reached[0].proven);
  // The best offset is taken now, so the next best is.
  problem.activities.push_back({"other", 0, 0, 100, 10, {0, 99}, {}, 65});
  outcome = solve(problem, {&objective, 1});
  EXPECT_EQ(outcome.solution->offsets[1], 75);
  EXPECT_THAT(violations(problem, *outcome.solution), IsEmpty());
}

TEST(SynthesisSolve, AFunctionOnTooLargeARasterIsDescended) {
  Problem problem;
  for (int at = 0; at < 5; ++at)
    problem.activities.push_back({"a" + std::to_string(at), 0, {}, 1000, 1, {0, 999}, {}, {}});
  Objective objective = least(Of::kFunction);
  objective.function = [](std::span<const Ticks> offsets) {
    double sum = 0;
    for (std::size_t at = 0; at < offsets.size(); ++at)
      sum += std::abs(static_cast<double>(offsets[at]) - 100.0 * static_cast<double>(at));
    return sum;
  };
  const Outcome outcome = solve(problem, {&objective, 1}, {.exhaustion = 20'000});
  EXPECT_EQ(outcome.reached[0].value, 0);
  EXPECT_FALSE(outcome.reached[0].proven);
  EXPECT_EQ(outcome.solution->offsets, (std::vector<Ticks>{0, 100, 200, 300, 400}));
}

}  // namespace
}  // namespace ttf::schedules::synthesis::solver
