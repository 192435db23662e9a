#include "schedules/synthesis/solver/decide.h"

#include <gtest/gtest.h>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/model.h"
#include "tests/schedules/synthesis/by_hand/oracle.h"

namespace ttf::schedules::synthesis::solver {
namespace {

TEST(SynthesisDecide, AgreesWithAllOffsetsTried) {
  int feasible = 0, infeasible = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const Problem problem = by_hand::drawn(seed, seed % 2 == 0);
    Decider decider({}, nullptr);
    const Verdict verdict = decider.decide({problem, {}, {}});
    const bool expected = by_hand::feasible(problem);
    ASSERT_EQ(verdict.kind, expected ? Verdict::Kind::kFeasible : Verdict::Kind::kInfeasible)
        << seed << ' ' << decider.way();
    (expected ? feasible : infeasible) += 1;
    EXPECT_TRUE(!expected || by_hand::keeps(problem, verdict.solution.offsets)) << seed;
  }
  EXPECT_GT(feasible, 100);
  EXPECT_GT(infeasible, 100);
}

TEST(SynthesisDecide, TermsOfChainsBoundEveryAgeAndMeetItIfPairwise) {
  int pairwise = 0, other = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const Problem problem = by_hand::drawn(seed, seed % 2 == 0);
    RandomStream draws({.seed = seed, .purpose = Purpose::kTest, .index = 2});
    std::vector<Ticks> offsets;
    for (const Activity& activity : problem.activities)
      offsets.push_back(draws.integer(-activity.period, activity.period));
    for (const Chain& chain : problem.chains) {
      const ChainTerms terms = terms_of(problem, chain);
      Ticks least = terms.base;
      for (std::size_t link = 0; link + 1 < chain.activities.size(); ++link)
        least += modulo(offsets[chain.activities[link + 1]] - offsets[chain.activities[link]] - terms.ready[link],
                        terms.modulus[link]);
      const Ticks counted = by_hand::age(problem, chain, offsets);
      EXPECT_TRUE(!terms.pairwise || counted == least) << seed << ": " << counted << ", " << least;
      EXPECT_GE(counted, least) << seed;
      (terms.pairwise ? pairwise : other) += 1;
    }
  }
  EXPECT_GT(pairwise, 300);
  EXPECT_GT(other, 300);
}

TEST(SynthesisDecide, SumsAndSpansAreKept) {
  int asked = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Problem problem = by_hand::drawn(seed, true);
    if (problem.chains.size() < 2) continue;
    const std::vector<Ticks> weights = {1, 2};
    Ticks least_sum = kNoLimit, least_span = kNoLimit;
    by_hand::for_all(problem, [&](const std::vector<Ticks>& offsets) {
      least_sum = std::min(least_sum, by_hand::age(problem, problem.chains[0], offsets) +
                                          2 * by_hand::age(problem, problem.chains[1], offsets));
      Ticks first = kNoLimit, last = -kNoLimit;
      for (std::size_t at = 0; at < offsets.size(); ++at)
        first = std::min(first, offsets[at]), last = std::max(last, offsets[at] + problem.activities[at].duration);
      least_span = std::min(least_span, last - first);
    });
    if (least_sum == kNoLimit) continue;
    ++asked;
    std::vector<std::size_t> all;
    for (std::size_t at = 0; at < problem.activities.size(); ++at) all.push_back(at);
    for (const Ticks below : {0, 1}) {
      const auto expected = below == 0 ? Verdict::Kind::kFeasible : Verdict::Kind::kInfeasible;
      Decider decider({}, nullptr);
      EXPECT_EQ(decider.decide({problem, {{{0, 1}, weights, least_sum - below}}, {}}).kind, expected) << seed;
      EXPECT_EQ(decider.decide({problem, {}, {{all, least_span - below}}}).kind, expected) << seed;
    }
  }
  EXPECT_GT(asked, 60);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::solver
