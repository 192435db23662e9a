// Two changes at a time to the paper's plan: hundreds of plans, most of which have no solution.
#include "schedules/check/checker.h"
#include "schedules/synthesis/explanation/explain.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::explanation {

using instants::feasible;
using instants::Feasible;
using instants::Synthesis;
using instants::synthesize;
namespace {

struct Mutation {
  const char* pattern;
  std::vector<const char*> values;
};

// Each changed plan is solved, and its cluster passes the check. Or one sentence refuses it. Or it is explained.
TEST(Explain, HundredsOfChangedPlansAreSolvedOrExplained) {
  const std::string shorter =
      changed(plan_text("paper"), "cycle: \\{[^}]*\\}", "cycle: {shortest: 8.5 ms, longest: 8.6 ms, step: 100 us}");
  const std::vector<Mutation> first{
      {"laser: \\{shortest: 34 ms, longest: [^}]*\\}",
       {"laser: {shortest: 34 ms, longest: 35 ms}", "laser: {shortest: 20 ms, longest: 30 ms}",
        "laser: {shortest: 60 ms, longest: 70 ms}"}},
      {"laser, to: feature.use, largest_age: 60 ms",
       {"laser, to: feature.use, largest_age: 55 ms", "laser, to: feature.use, largest_age: 54 ms",
        "laser, to: fusion.fuse_laser, largest_age: 52 ms"}},
      {"worst_case: 26 ms", {"worst_case: 20 ms", "worst_case: 33 ms", "worst_case: 40 ms"}},
      {"worst_case: 34 ms", {"worst_case: 30 ms", "worst_case: 36 ms", "worst_case: 70 ms"}},
      {"max_elements: 1300", {"max_elements: 140", "max_elements: 2000"}},
      {"flexray: \\{pKeySlotId: 1\\}", {"flexray: {pKeySlotId: 2}", "flexray: {pKeySlotId: 40}"}},
  };
  const std::vector<Mutation> second{
      {"max_elements: 25\n *elements_per_fragment: 2",
       {"max_elements: 8\n    elements_per_fragment: 2", "max_elements: 160\n    elements_per_fragment: 2"}},
      {"\\{sender: fusion, pdu: image\\}",
       {"{slot: 30, base_cycle: 2, sender: fusion, pdu: image}", "{slot: 3, base_cycle: 0, sender: fusion, pdu: image}",
        "{slot: 80, base_cycle: 0, sender: fusion, pdu: image}"}},
      {"(step: image_output\n *activation: \\{kind: time)",
       {"$1, base_cycle: 3, offset: 8000", "$1, base_cycle: 0, offset: 100"}},
      {"real_time: \\{[^}]*\\}", {"real_time: {early: 100 us, late: 8 ms}", "real_time: {early: 100 us, late: 1 us}"}},
      {"worst_case: 1 ms", {"worst_case: 35 ms", "worst_case: 100 us"}},
      {"gNumberOfMinislots: 196", {"gNumberOfMinislots: 1200", "gNumberOfMinislots: 0"}},
  };
  int solved = 0, refused = 0, explained = 0;
  for (const Mutation& a : first)
    for (const char* one : a.values)
      for (const Mutation& b : second)
        for (const char* other : b.values) {
          SCOPED_TRACE(std::string(one) + " and " + other);
          const std::string text = changed(changed(shorter, a.pattern, one), b.pattern, other);
          try {
            const plan::Plan plan = plan::parse_plan(text, "plan.yaml");
            const Synthesis made = synthesize(plan);
            if (made.found) {
              ++solved;
              EXPECT_TRUE(check::check(made.cluster).empty());
            } else if (!made.refused.empty()) {
              ++refused;
            } else {
              ++explained;
              EXPECT_FALSE(explain(plan).core.empty());
            }
          } catch (const InputError& error) {
            ++refused;
            EXPECT_GT(error.findings()[0].line, 0) << error.findings()[0].sentence();
          }
        }
  EXPECT_GT(solved, 30);
  EXPECT_GT(explained, 30);
  EXPECT_GT(refused, 10);
  EXPECT_GT(solved + refused + explained, 200);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::explanation
