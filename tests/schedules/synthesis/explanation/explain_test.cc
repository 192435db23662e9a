// Plans without a solution are explained in their own words.
#include "schedules/synthesis/explanation/explain.h"

#include <algorithm>

#include "schedules/synthesis/instants/synthesize.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::explanation {

using instants::feasible;
using instants::Feasible;
using instants::Synthesis;
using instants::synthesize;
namespace {

bool says(const std::vector<Explanation::Said>& list, const std::string& words) {
  return std::any_of(list.begin(), list.end(),
                     [&](const auto& one) { return one.text.find(words) != std::string::npos; });
}

TEST(Explain, AnAgeThatIsTooSmallAndByHowMuch) {
  const std::string text = changed(plan_text("paper"), "largest_age: 60 ms", "largest_age: 50 ms");
  const plan::Plan plan = plan::parse_plan(text, "plan.yaml");
  const Synthesis made = synthesize(plan);
  EXPECT_FALSE(made.found);
  EXPECT_TRUE(made.exact);
  const Explanation why = explain(plan);
  EXPECT_TRUE(why.proven);
  ASSERT_TRUE(says(why.core, "plan.chains.laser.largest_age: 50 ms"));
  for (const auto& one : why.core) EXPECT_TRUE(one.line > 0 || one.text == "plan.in_order: true") << one.text;
  EXPECT_FALSE(says(why.core, "camera"));  // the camera has no part in it
  // The least age of the laser is 54.91 ms: the sum of its way, without a wait.
  EXPECT_TRUE(says(why.changes, "plan.chains.laser.largest_age: 54."));
}

TEST(Explain, APeriodThatIsShorterThanTheExecution) {
  const std::string text = changed(plan_text("paper"), "laser: \\{shortest: 34 ms, longest: [^}]*\\}",
                                   "laser: {shortest: 30 ms, longest: 33 ms}");
  const Explanation why = explain(plan::parse_plan(text, "plan.yaml"));
  EXPECT_TRUE(says(why.core, "plan.rates.laser.longest: 33 ms") || says(why.core, "plan.cycle"));
}

// A largest age is one by any clock, as `schedule check` bounds it. Just above the best it holds. Just below it does not.
TEST(Explain, LargestAgesAreThoseOfTheCheck) {
  const std::string one_cycle =
      changed(plan_text("paper"), "cycle: \\{[^}]*\\}", "cycle: {shortest: 8535 us, longest: 8535 us, step: 100 us}");
  const Synthesis made = synthesize(plan::parse_plan(one_cycle, "plan.yaml"));
  ASSERT_TRUE(made.found);
  const auto with = [&](std::int64_t us) {
    const std::string age = "largest_age: " + std::to_string(us) + " us";
    return feasible(
        plan::parse_plan(changed(changed(one_cycle, "largest_age: 60 ms", age), "largest_age: 60 ms", age), "p"));
  };
  const std::int64_t best_us = std::max(made.ages[0].worst, made.ages[1].worst).ns / 1'000;
  EXPECT_TRUE(with(best_us + 2).found);
  EXPECT_FALSE(with(best_us - 2).found);
}

// An offered value passes the check, too: the task ends before its next activation. A best case bounds them.
TEST(Explain, OfferedValuesPassTheCheck) {
  const std::string text = changed(plan_text("paper"), "(use:\\n(?: .*\\n)*?        worst_case:) 1 ms", "$1 40 ms");
  const Explanation why = explain(plan::parse_plan(text, "plan.yaml"));
  const std::string key = "nodes.feature.tasks.use.worst_case: ";
  const auto offered =
      std::find_if(why.changes.begin(), why.changes.end(), [&](const auto& one) { return one.text.starts_with(key); });
  ASSERT_NE(offered, why.changes.end());
  const std::string mended = changed(text, "worst_case: 40 ms", "worst_case: " + offered->text.substr(key.size()));
  EXPECT_TRUE(synthesize(plan::parse_plan(mended, "plan.yaml")).found) << offered->text;
}

// The least change of a number is enough, and the next smaller one is not.
TEST(Explain, ChangesAreTheLeastOnes) {
  const std::string text = changed(plan_text("paper"), "largest_age: 60 ms", "largest_age: 54 ms");
  const Explanation why = explain(plan::parse_plan(text, "plan.yaml"));
  const std::string key = "plan.chains.laser.largest_age: ";
  for (const auto& one : why.changes) {
    if (!one.text.starts_with(key)) continue;
    const std::string value = one.text.substr(key.size());
    EXPECT_TRUE(feasible(plan::parse_plan(changed(text, "largest_age: 54 ms", "largest_age: " + value), "p")).found);
    const double less = std::stod(value) - 0.01;
    EXPECT_FALSE(feasible(plan::parse_plan(
                              changed(text, "largest_age: 54 ms", "largest_age: " + std::to_string(less) + " ms"), "p"))
                     .found);
    return;
  }
  FAIL() << "no change of the laser's age";
}

// With fewer slots the idle time is too long in this cycle of 8,535 macroticks: 7,551 - 80 * 84 > 805.
TEST(Explain, TooFewSlotsAndHowManyAreEnough) {
  const std::string one_cycle =
      changed(plan_text("paper"), "cycle: \\{[^}]*\\}", "cycle: {shortest: 8535 us, longest: 8535 us, step: 100 us}");
  const std::string text = changed(one_cycle, "  gdSymbolWindow:", "  gNumberOfStaticSlots: 60\n  gdSymbolWindow:");
  const plan::Plan plan = plan::parse_plan(text, "plan.yaml");
  EXPECT_FALSE(feasible(plan).found);
  const Explanation why = explain(plan);
  EXPECT_TRUE(says(why.core, "flexray.gNumberOfStaticSlots: 60"));
  EXPECT_TRUE(says(why.changes, "flexray.gNumberOfStaticSlots: 81"));
}

}  // namespace
}  // namespace ttf::schedules::synthesis::explanation
