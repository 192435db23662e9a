#include "schedules/synthesis/instants/proof.h"

#include <gtest/gtest.h>

#include "schedules/check/checker.h"
#include "schedules/exchange/cluster_yaml.h"
#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/smt/z3_prover.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::instants {
namespace {

Reading reading_of(const plan::Plan& plan, Duration cycle) {
  return read_of(plan, {cycle, std::vector<int>(plan.sensors.size(), 4), 0, {}})->reading;
}

// The paper's plan, where the search ends with a proof of its own.
TEST(SynthesisProof, SearchAndSolverAgree) {
  if (!smt::Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  const plan::Plan plan = plan::load_plan(plan_path("paper"));
  for (const int us : {8535, 8600, 8995}) {
    const Reading reading = reading_of(plan, Duration::microseconds(us));
    const Search searched = place(reading, {});
    ASSERT_TRUE(searched.best && searched.exact) << us;
    const Ticks best = searched.best->worst_age({});
    smt::Z3Prover prover;
    Limits limits;
    limits.worst_age = best + 100;
    const Settled settled = settle(reading, limits, &prover);
    ASSERT_TRUE(settled.best) << us;
    EXPECT_EQ(settled.best->worst_age({}), best) << us;
    EXPECT_EQ(settled.bound, best) << us;
    EXPECT_FALSE(settled.open) << us;
    limits.worst_age = best - 1;
    EXPECT_TRUE(settle(reading, limits, &prover).none) << us;
  }
}

// Negative gaps: data is there before the end of a task whose duration allows for corrections of the clock.
TEST(SynthesisProof, TheProblemOfAPlanMakesSenseToTheSolver) {
  const plan::Plan plan = plan::load_plan(plan_path("paper_two_lasers_radar"));
  const Reading reading = reading_of(plan, Duration::microseconds(8535));
  EXPECT_LT(reading.problem.chains[0].gaps[1], 0);
  const auto problem = relaxed(reading, {});
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->chains.size(), 4u);
  EXPECT_EQ(problem->orders.size(), 12u);
  // Offsets of the search keep it.
  const Search searched = place(reading, {});
  ASSERT_TRUE(searched.best);
  EXPECT_TRUE(violations(*problem, searched.best->solution).empty());
}

plan::Plan four_sensors() {
  plan::Plan plan = plan::load_plan(plan_path("paper_two_lasers_radar"));
  plan.cycle.shortest = plan.cycle.longest = Duration::microseconds(8535);
  plan.objective = {plan::Goal::kWorstAge};
  return plan;
}

TEST(SynthesisProof, IntegersCloseTheGapThatTheSearchLeaves) {
  const Synthesis searched = synthesize(four_sensors());
  ASSERT_TRUE(searched.found);
  EXPECT_FALSE(searched.reached[0].proven);
  EXPECT_NEAR(searched.reached[0].value - searched.reached[0].bound, 0.055, 1e-9);
  if (!smt::Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  smt::Z3Prover prover;
  const Synthesis proven = synthesize(four_sensors(), &prover);
  ASSERT_TRUE(proven.found);
  EXPECT_TRUE(proven.reached[0].proven);
  EXPECT_EQ(proven.reached[0].way, "integers");
  EXPECT_EQ(proven.reached[0].value, searched.reached[0].value);
  EXPECT_TRUE(check::check(proven.cluster).empty());
}

// The search's own answer withheld: the solver finds one as good, and it keeps the order of the lists.
TEST(SynthesisProof, TheSolversOffsetsKeepThePlan) {
  if (!smt::Z3Prover::there()) GTEST_SKIP() << "built without Z3";
  const Reading reading = reading_of(four_sensors(), Duration::microseconds(8535));
  smt::Z3Prover prover;
  const Settled settled = settle(reading, {}, &prover, true);
  ASSERT_TRUE(settled.best);
  EXPECT_TRUE(violations(*relaxed(reading, {}), settled.best->solution).empty());
  for (std::size_t c = 0; c < reading.problem.chains.size(); ++c)
    EXPECT_LE(settled.best->ages[c], reading.problem.chains[c].largest_age.value_or(1'000'000));
  Limits limits;
  limits.last_slot = 84;  // the first slot has no room for all
  EXPECT_FALSE(settle(reading, limits, &prover, true).best);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::instants
