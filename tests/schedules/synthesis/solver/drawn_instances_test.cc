// The drawn problems of 6 nodes at loads of 70 %, seeds 1 to 20: each largest age is proven least. Z3, which shares no search with
// the solver, says the same of few chains: these cannot all be younger, whatever else there is.
#include <gtest/gtest.h>

#include <algorithm>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/generator.h"
#include "schedules/synthesis/smt/z3_prover.h"
#include "schedules/synthesis/solver/bounds.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis::solver {
namespace {

struct Known {
  Ticks least = 0;                  // the largest age [us]
  std::vector<std::size_t> chains;  // they cannot all be younger
};

// By seed, from 1.
const std::vector<Known> kInstances = {{308539, {2}},   {226454, {6, 7}}, {78444, {3}},        {72569, {0}},
                                       {30734, {0}},    {78974, {0}},     {323164, {2, 3}},    {27783, {1}},
                                       {81468, {2, 7}}, {163141, {3}},    {437547, {2, 3}},    {161420, {1}},
                                       {306173, {0}},   {316014, {2, 3}}, {319532, {5, 6}},    {320426, {0}},
                                       {323341, {4}},   {160063, {6}},    {321645, {0, 3, 6}}, {160614, {5}}};

TEST(SynthesisDrawnInstances, LargestAgesAreProvenLeastWithoutZ3) {
  for (std::size_t at = 0; at < kInstances.size(); ++at) {
    const Problem problem = generated({.seed = at + 1});
    const Objective largest;
    const Outcome outcome = solve(problem, {&largest, 1});
    ASSERT_TRUE(outcome.solution) << at + 1;
    EXPECT_TRUE(violations(problem, *outcome.solution).empty()) << at + 1;
    EXPECT_TRUE(outcome.reached[0].proven) << at + 1 << ": " << outcome.reached[0].bound;
    EXPECT_EQ(outcome.reached[0].value, static_cast<double>(kInstances[at].least)) << at + 1;
    EXPECT_EQ(std::ranges::max(ages(problem, *outcome.solution)), kInstances[at].least) << at + 1;
  }
}

TEST(SynthesisDrawnInstances, IntegersSayThatFewChainsCannotBeYounger) {
  if (!smt::Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  for (std::size_t at = 0; at < kInstances.size(); ++at) {
    Problem problem = generated({.seed = at + 1});
    std::vector<std::size_t> activities;
    for (const std::size_t chain : kInstances[at].chains) {
      problem.chains[chain].largest_age = kInstances[at].least - 1;
      const std::vector<std::size_t>& along = problem.chains[chain].activities;
      activities.insert(activities.end(), along.begin(), along.end());
    }
    Part part = part_of(problem, activities);
    for (const std::size_t chain : kInstances[at].chains) part.add(problem.chains[chain]);
    smt::Z3Prover prover;
    const Verdict verdict = prover.decide({part.problem, {}, {}}, 1.0, [](const Solution&) { return std::nullopt; });
    EXPECT_EQ(verdict.kind, Verdict::Kind::kInfeasible) << at + 1;
  }
}

}  // namespace
}  // namespace ttf::schedules::synthesis::solver
