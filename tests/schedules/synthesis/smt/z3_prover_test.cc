#include "schedules/synthesis/smt/z3_prover.h"

#include <gtest/gtest.h>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/decide.h"
#include "tests/schedules/synthesis/by_hand/oracle.h"

namespace ttf::schedules::synthesis::smt {
namespace {

using Kind = solver::Verdict::Kind;

std::optional<Solution> unrepaired(const Solution&) { return std::nullopt; }

// Both logics, alone: no search helps, and every answer is held against all offsets tried.
TEST(SynthesisZ3, AgreesWithAllOffsetsTried) {
  if (!Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  int feasible = 0, infeasible = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    const Problem problem = by_hand::drawn(seed, seed % 2 == 0);
    const bool expected = by_hand::feasible(problem);
    for (const Logic logic : {Logic::kIntegers, Logic::kDifferences}) {
      Z3Prover prover(logic);
      const solver::Verdict verdict = prover.decide({problem, {}, {}}, 1.0, unrepaired);
      ASSERT_EQ(verdict.kind, expected ? Kind::kFeasible : Kind::kInfeasible) << seed;
      EXPECT_TRUE(!expected || by_hand::keeps(problem, verdict.solution.offsets)) << seed;
    }
    (expected ? feasible : infeasible) += 1;
  }
  EXPECT_GT(feasible, 10);
  EXPECT_GT(infeasible, 10);
}

// Orders and data that is there early: the search and the prover together, held against all offsets tried.
TEST(SynthesisZ3, KeepsOrders) {
  if (!Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  int feasible = 0, infeasible = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Problem problem = by_hand::drawn_in_order(seed);
    if (problem.orders.empty()) continue;
    const bool expected = by_hand::feasible(problem);
    Z3Prover prover;
    solver::Decider decider({}, &prover);
    for (const solver::Verdict& verdict :
         {prover.decide({problem, {}, {}}, 1.0, unrepaired), decider.decide({problem, {}, {}})}) {
      ASSERT_EQ(verdict.kind, expected ? Kind::kFeasible : Kind::kInfeasible) << seed;
      EXPECT_TRUE(!expected || by_hand::keeps(problem, verdict.solution.offsets)) << seed;
    }
    (expected ? feasible : infeasible) += 1;
  }
  EXPECT_GT(feasible, 10);
  EXPECT_GT(infeasible, 10);
}

TEST(SynthesisZ3, KeepsSumsAndSpans) {
  if (!Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  int asked = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    const Problem problem = by_hand::drawn(seed, true);
    if (problem.chains.size() < 2) continue;
    Ticks least_sum = 1000, least_span = 1000;
    std::vector<std::size_t> all;
    for (std::size_t at = 0; at < problem.activities.size(); ++at) all.push_back(at);
    by_hand::for_all(problem, [&](const std::vector<Ticks>& offsets) {
      least_sum = std::min(least_sum, by_hand::age(problem, problem.chains[0], offsets) +
                                          2 * by_hand::age(problem, problem.chains[1], offsets));
      Ticks first = 1000, last = -1000;
      for (const std::size_t at : all)
        first = std::min(first, offsets[at]), last = std::max(last, offsets[at] + problem.activities[at].duration);
      least_span = std::min(least_span, last - first);
    });
    if (least_sum == 1000) continue;
    ++asked;
    for (const Ticks below : {0, 1}) {
      const Kind expected = below == 0 ? Kind::kFeasible : Kind::kInfeasible;
      EXPECT_EQ(Z3Prover().decide({problem, {{{0, 1}, {1, 2}, least_sum - below}}, {}}, 1.0, unrepaired).kind, expected)
          << seed;
      EXPECT_EQ(Z3Prover().decide({problem, {}, {{all, least_span - below}}}, 1.0, unrepaired).kind, expected) << seed;
    }
  }
  EXPECT_GT(asked, 10);
}

TEST(SynthesisZ3, WithoutStepsThereIsNoAnswer) {
  const Problem problem = by_hand::drawn(4, true);
  Z3Prover prover(Logic::kIntegers, 1);
  EXPECT_EQ(prover.decide({problem, {}, {}}, 1.0, unrepaired).kind, Kind::kUnknown);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::smt
