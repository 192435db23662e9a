#include "schedules/synthesis/generator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/solve.h"

namespace ttf::schedules::synthesis {
namespace {

using testing::IsEmpty;

// Counts the busy ticks of a resource from its activities over the longest period.
double counted_load(const Problem& problem, std::size_t resource, Ticks common) {
  Ticks busy = 0;
  for (const Activity& activity : problem.activities)
    if (activity.resource == resource) busy += common / activity.period * activity.duration;
  return static_cast<double>(busy) / static_cast<double>(common);
}

TEST(SynthesisGenerator, LoadsAreAsPromised) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double load : {0.5, 0.7}) {
      const Shape shape{.load = load, .seed = seed};
      const Problem problem = generated(shape);
      ASSERT_THAT(mistakes(problem), IsEmpty());
      ASSERT_EQ(problem.resources.size(), 7u);
      const Ticks common = shape.cycle * 64;
      for (std::size_t node = 0; node < 6; ++node) {
        EXPECT_NEAR(load_of(problem, node), load, 0.002) << seed << ' ' << node;
        EXPECT_NEAR(counted_load(problem, node, common), load, 0.002) << seed << ' ' << node;
      }
      const Activity& frame = problem.activities.back();
      const double slots = static_cast<double>(frame.grid.last / frame.grid.step + 1);
      EXPECT_NEAR(load_of(problem, 6),
                  counted_load(problem, 6, common) * static_cast<double>(shape.cycle) /
                      (slots * static_cast<double>(frame.duration)),
                  1e-9);
      EXPECT_LE(load_of(problem, 6), load + 1e-9) << seed;
      EXPECT_GT(load_of(problem, 6), load - 1 / slots) << seed;
    }
}

TEST(SynthesisGenerator, HasTheShapeThatWasAskedFor) {
  std::set<Ticks> periods;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Problem problem = generated({.tasks = 30, .messages = 40, .seed = seed});
    EXPECT_EQ(problem.activities.size(), 70u);
    EXPECT_EQ(problem.precedences.size(), 40u);
    ASSERT_EQ(problem.chains.size(), 10u);  // half of the messages, two in each
    for (const Activity& activity : problem.activities) periods.insert(activity.period);
    for (const Chain& chain : problem.chains) {
      ASSERT_EQ(chain.activities.size(), 5u);
      std::set<std::size_t> nodes;
      for (const std::size_t at : {0, 2, 4}) nodes.insert(*problem.activities[chain.activities[at]].resource);
      EXPECT_EQ(nodes.size(), 3u);
      for (const std::size_t at : {1, 3}) EXPECT_EQ(*problem.activities[chain.activities[at]].resource, 6u);
    }
  }
  EXPECT_EQ(periods, (std::set<Ticks>{5000, 10'000, 20'000, 40'000, 80'000, 160'000, 320'000}));
}

TEST(SynthesisGenerator, OneSeedMakesOneProblem) {
  const Problem one = generated({.seed = 3}), same = generated({.seed = 3}), other = generated({.seed = 4});
  const auto durations = [](const Problem& problem) {
    std::vector<Ticks> found;
    for (const Activity& activity : problem.activities)
      found.push_back(activity.duration), found.push_back(activity.period);
    return found;
  };
  EXPECT_EQ(durations(one), durations(same));
  EXPECT_NE(durations(one), durations(other));
}

}  // namespace
}  // namespace ttf::schedules::synthesis
