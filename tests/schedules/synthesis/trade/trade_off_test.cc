// The front of ages and slots, and the binding pieces, against independent counts.
#include "schedules/synthesis/trade/trade_off.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/reading.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/loader.h"
#include "schedules/synthesis/trade/binding.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::trade {
namespace {

plan::Plan paper() { return plan::load_plan(TTF_SOURCE_DIR "/schedules/plans/paper.yaml"); }

TEST(TradeOff, TheFrontEndsWithTheLeastAgeThatSynthesisProves) {
  const plan::Plan planned =
      plan::parse_plan(changed(plan_text("paper"), "objective: .*", "objective: [worst_age, slots]"), "paper.yaml");
  const instants::Synthesis made = instants::synthesize(planned);
  ASSERT_TRUE(made.found);
  const TradeOff found = trade_off(planned);
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.candidates.size() + found.without, made.candidates);
  ASSERT_FALSE(found.front.empty());
  Duration worst{};
  for (const instants::AgeBounds& age : made.ages) worst = std::max(worst, age.worst);
  EXPECT_EQ(found.front.front().worst_age, worst);
  EXPECT_TRUE(found.front.front().proven());
  EXPECT_EQ(found.front.front().slots, made.reached.back().value);
  const auto least = std::min_element(found.candidates.begin(), found.candidates.end(),
                                      [](const auto& a, const auto& b) { return a.worst_age < b.worst_age; });
  EXPECT_EQ(least->worst_age, worst);
}

// Fewer slots make no age smaller. Between two steps no number of slots has an age below the step before it.
TEST(TradeOff, EachStepHasFewerSlotsAndALargerAge) {
  const plan::Plan planned = paper();
  const TradeOff found = trade_off(planned);
  ASSERT_GE(found.front.size(), 2U);
  for (std::size_t i = 1; i < found.front.size(); ++i) {
    EXPECT_LT(found.front[i].slots, found.front[i - 1].slots);
    EXPECT_GT(found.front[i].worst_age, found.front[i - 1].worst_age);
    EXPECT_LE(found.front[i].bound, found.front[i].worst_age);
  }
  // One slot less than the last step is impossible for every candidate. A search of its own says so.
  for (const instants::Candidate& candidate : instants::candidates(planned)) {
    const auto read = instants::read_of(planned, candidate);
    if (!read) continue;
    instants::Limits limits;
    limits.last_slot = Ticks{found.front.back().slots - 1} * read->timed.cluster.flexray.gdStaticSlot;
    const instants::Search fewer = instants::place(read->reading, limits, true);
    EXPECT_FALSE(fewer.best) << in_ms(candidate.cycle);
  }
}

TEST(TradeOff, AJudgeSeesEveryPoint) {
  int judged = 0;
  const TradeOff found = trade_off(paper(), [&](const model::Cluster& cluster) {
    ++judged;
    return in_ms(cluster.cycle());
  });
  EXPECT_GE(judged, static_cast<int>(found.candidates.size()));
  for (const TradeOffPoint& point : found.candidates) EXPECT_EQ(point.judged, in_ms(point.candidate.cycle));
}

TEST(TradeOff, EndsByACountOfSteps) {
  const TradeOff found = trade_off(paper(), {}, 1);
  EXPECT_FALSE(found.complete);
}

// Four sensors take the search many steps. Each search has a share of them, so the front gets some, too. Its first step
// is no older than the best of the candidates.
TEST(TradeOff, AFrontHasStepsLeftBehindLongSearches) {
  plan::Plan planned = plan::load_plan(plan_path("paper_two_lasers_radar"));
  planned.cycle.longest = planned.cycle.shortest + planned.cycle.step * 8;
  const TradeOff found = trade_off(planned, {}, 200'000);
  ASSERT_FALSE(found.candidates.empty());
  ASSERT_GT(found.front.size(), 1u);
  EXPECT_LT(found.steps, 400'000);
  Duration least = found.candidates.front().worst_age;
  for (const TradeOffPoint& point : found.candidates) least = std::min(least, point.worst_age);
  EXPECT_LE(found.front.front().worst_age, least);
  for (const TradeOffPoint& point : found.front) EXPECT_LE(point.bound, point.worst_age);
}

TEST(Binding, PiecesAddUpToTheWorstAge) {
  const plan::Plan planned = paper();
  const instants::Synthesis made = instants::synthesize(planned);
  ASSERT_TRUE(made.found);
  const auto ways = what_binds(planned, made);
  ASSERT_EQ(ways.size(), 2U);
  for (std::size_t c = 0; c < ways.size(); ++c) {
    EXPECT_EQ(ways[c].worst_age, made.ages[c].worst);
    Duration sum{};
    for (const WayPiece& piece : ways[c].pieces) sum = sum + piece.time;
    EXPECT_EQ(sum, ways[c].worst_age);
    // Clocks take little. The rest is explained.
    EXPECT_EQ(ways[c].pieces.back().kind, WayPiece::Kind::kClocks);
    EXPECT_LT(std::abs(ways[c].pieces.back().time.ns), 500'000) << ways[c].chain;
  }
}

// The laser's preprocessing is on the longest way. 1 ms less of it is 1 ms less of the worst age. The camera's changes nothing.
TEST(Binding, AShorterExecutionHelpsWhereItBinds) {
  const plan::Plan planned = paper();
  const instants::Synthesis made = instants::synthesize(planned);
  const auto ways = what_binds(planned, made);
  const auto of = [&](std::size_t chain, const std::string& name) {
    for (const WayPiece& piece : ways[chain].pieces)
      if (piece.name == name && piece.shorter) return *piece.shorter;
    ADD_FAILURE() << name;
    return Shorter{};
  };
  const Shorter laser = of(0, "laser_pre.preprocess executes"), camera = of(1, "camera_pre.preprocess executes");
  EXPECT_EQ(laser.by, Duration::milliseconds(1));
  EXPECT_EQ(laser.worst_age, Duration::milliseconds(1));
  EXPECT_EQ(camera.worst_age, Duration{});
}

}  // namespace
}  // namespace ttf::schedules::synthesis::trade
