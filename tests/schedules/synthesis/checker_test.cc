#include "schedules/synthesis/checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/schedules/synthesis/by_hand/oracle.h"

namespace ttf::schedules::synthesis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Two tasks and a message between them, cycle 10, slots of 2 from 0 to 6.
Problem pipeline() {
  Problem problem;
  problem.resources = {{"sender"}, {"segment"}, {"receiver"}};
  problem.activities = {{"scan", 3, 0, 10, 3, {0, 9}, {}, {}},
                        {"frame", 4, 1, 10, 2, {0, 19}, {10, 0, 6, 2}, {}},
                        {"fuse", 5, 2, 20, 4, {0, 39}, {}, {}}};
  problem.precedences = {{0, 1, 1, std::nullopt, 7}};
  problem.chains = {{"front", {0, 1, 2}, {}, 30, true, 8}};
  return problem;
}

TEST(SynthesisChecker, CountsAgesByTheirDefinition) {
  const Problem problem = pipeline();
  // scan 0..3, frame 4..6, fuse 6..10: nothing rests but from 3 to 4.
  EXPECT_EQ(age(problem, problem.chains[0], {{0, 4, 6}}), 10);
  EXPECT_EQ(age(problem, problem.chains[0], {{0, 4, 5}}), 19);  // reads the frame of the cycle before
  Problem in_force = problem;
  in_force.chains[0].reduced = false;
  EXPECT_EQ(age(in_force, in_force.chains[0], {{0, 4, 6}}), 30);
  in_force.chains[0].gaps = {2, 0};  // the scan is ready at 5: the frame has the one before
  EXPECT_EQ(age(in_force, in_force.chains[0], {{0, 4, 6}}), 40);
  EXPECT_THAT(violations(problem, {{0, 4, 6}}), IsEmpty());
}

// Published ages of LET chains (reduced: the read to the output). A LET task with period T is an activity of duration T.
TEST(SynthesisChecker, AgreesWithPublishedAgesOfLetChains) {
  struct Row {
    std::vector<Ticks> periods;
    Ticks mda, mrda;
    Ticks second = 0;
  };
  for (const Row& row : std::vector<Row>{{{10, 20}, 50, 30},
                                         {{20, 10}, 50, 40},
                                         {{10, 15}, 45, 30},
                                         {{5, 10, 20}, 55, 35},
                                         {{10, 20, 50}, 140, 90},
                                         {{10, 20}, 55, 35, 5}}) {
    Problem problem;
    Chain chain{"let", {}, {}, {}, true, 0};
    Solution solution;
    for (const Ticks period : row.periods) {
      chain.activities.push_back(problem.activities.size());
      solution.offsets.push_back(problem.activities.size() == 1 ? row.second : 0);
      problem.activities.push_back({"t", 0, {}, period, period, {0, period}, {}, {}});
    }
    EXPECT_EQ(age(problem, chain, solution), row.mrda) << row.periods.front() << ' ' << row.periods.size();
    chain.reduced = false;
    EXPECT_EQ(age(problem, chain, solution), row.mda) << row.periods.front() << ' ' << row.periods.size();
  }
}

TEST(SynthesisChecker, NamesEachBrokenStatement) {
  const Problem problem = pipeline();
  const auto sentences = [&](Problem changed, const Solution& solution) { return violations(changed, solution); };
  EXPECT_THAT(sentences(problem, {{-1, 4, 6}}), ElementsAre("scan (line 3) begins at -1, outside 0..9"));
  EXPECT_THAT(sentences(problem, {{0, 5, 7}}), ElementsAre("frame (line 4) begins at 5, off its grid"));
  EXPECT_THAT(sentences(problem, {{4, 6, 8}}),
              ElementsAre("frame begins -1 behind the end of scan, not 1..10 (line 7)"));
  Problem changed = problem;
  changed.chains[0].largest_age = 9;
  EXPECT_THAT(sentences(changed, {{0, 4, 6}}), ElementsAre("chain front is 10 old, above 9 (line 8)"));
  changed = problem;
  changed.activities[2].resource = 0;
  EXPECT_THAT(sentences(changed, {{3, 14, 6}}), IsEmpty());
  EXPECT_THAT(sentences(changed, {{0, 4, 11}}), ElementsAre("scan (line 3) and fuse (line 5) overlap on sender"));
  changed = problem;
  changed.activities[1].fixed = 6;
  EXPECT_THAT(sentences(changed, {{0, 4, 6}}), ElementsAre("frame (line 4) is fixed at 6, not 4"));
}

// Two sensors' lists, read by tasks at 5 and 8 of a period of 20: that at 8 must rest on the later scan.
TEST(SynthesisChecker, CountsTheOrderOfData) {
  Problem problem;
  problem.resources = {{"reader"}};
  for (const char* name : {"laser", "radar"}) problem.activities.push_back({name, 0, {}, 20, 0, {0, 19}, {}, {}});
  for (const char* name : {"fuse laser", "fuse radar"})
    problem.activities.push_back({name, 0, 0, 20, 2, {0, 19}, {}, {}});
  problem.chains = {{"laser", {0, 2}, {}, {}, true, 0}, {"radar", {1, 3}, {}, {}, true, 0}};
  problem.orders = {{0, 1, 1, 1, 1}, {1, 1, 0, 1, 1}};
  EXPECT_THAT(mistakes(problem), IsEmpty());
  EXPECT_THAT(violations(problem, {{1, 2, 5, 8}}), IsEmpty());
  EXPECT_THAT(violations(problem, {{4, 3, 5, 8}}),
              ElementsAre("laser begins 2 too late for the order of its data with that of radar"));
  EXPECT_EQ(out_of_order(problem, problem.orders[1], {{1, 2, 5, 8}}), 2 + 1 - 21);
  problem.activities[1].period = 40;
  EXPECT_THAT(mistakes(problem),
              ElementsAre(HasSubstr("chain radar has several periods"), HasSubstr("chain radar has several periods")));
}

TEST(SynthesisChecker, NamesProblemsThatMakeNoSense) {
  EXPECT_THAT(mistakes(pipeline()), IsEmpty());
  const auto mistake = [](const std::function<void(Problem&)>& change) {
    Problem problem = pipeline();
    change(problem);
    const std::vector<std::string> found = mistakes(problem);
    return found.size() == 1 ? found.front() : std::to_string(found.size()) + " mistakes";
  };
  EXPECT_THAT(mistake([](Problem& p) { p.activities[0].period = 0; }),
              HasSubstr("scan (line 3): period 0 is not positive"));
  EXPECT_THAT(mistake([](Problem& p) { p.activities[0].duration = 11; }),
              HasSubstr("duration 11 is not 0..10, the period"));
  EXPECT_THAT(mistake([](Problem& p) { p.activities[1].resource = 3; }), HasSubstr("resource 3 of 3"));
  EXPECT_THAT(mistake([](Problem& p) { p.activities[1].grid.last = 10; }), HasSubstr("grid 0..10 in steps of 2"));
  EXPECT_THAT(mistake([](Problem& p) { p.precedences[0].after = 2; }),
              HasSubstr("scan and fuse have periods 10 and 20"));
  EXPECT_THAT(mistake([](Problem& p) { p.precedences[0].before = 9; }), HasSubstr("activity 9 of 3"));
  EXPECT_THAT(mistake([](Problem& p) { p.chains[0].activities = {}; }), HasSubstr("no activity"));
  EXPECT_THAT(mistake([](Problem& p) { p.chains[0].gaps = {1}; }), HasSubstr("1 gaps for 3 activities"));
  EXPECT_THAT(mistake([](Problem& p) { p.chains[0].gaps = {-4, 0}; }), HasSubstr("gap -4 is not -3.."));
  EXPECT_THAT(mistake([](Problem& p) {
                p.activities[2].period = 1048583, p.activities[0].period = p.activities[1].period = 1048573;
              }),
              HasSubstr("common multiple"));
}

TEST(SynthesisChecker, AgreesWithTimeLinesAndSamplesFollowedForwards) {
  int kept = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const Problem problem = seed % 5 == 0 ? by_hand::drawn_in_order(seed) : by_hand::drawn(seed, seed % 2 == 0);
    ASSERT_THAT(mistakes(problem), IsEmpty()) << seed;
    RandomStream draws({.seed = seed, .purpose = Purpose::kTest, .index = 1});
    Solution solution;
    for (const Activity& activity : problem.activities) {
      const std::vector<Ticks> choices = by_hand::choices(activity);
      solution.offsets.push_back(choices.empty() ? 0 : choices[draws.bits() % choices.size()]);
    }
    for (const Chain& chain : problem.chains)
      EXPECT_EQ(age(problem, chain, solution), by_hand::age(problem, chain, solution.offsets)) << seed;
    const bool placed =
        std::ranges::all_of(problem.activities, [](const Activity& a) { return !by_hand::choices(a).empty(); });
    const bool good = placed && by_hand::keeps(problem, solution.offsets);
    EXPECT_EQ(violations(problem, solution).empty(), good) << seed;
    kept += good;
  }
  EXPECT_GT(kept, 150);
  EXPECT_LT(kept, 1350);
}

}  // namespace
}  // namespace ttf::schedules::synthesis
