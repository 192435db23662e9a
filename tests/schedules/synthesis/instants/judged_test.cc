// The search for the least value of a judge, with judges whose answers are known.
#include "schedules/synthesis/instants/judging/judged.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/random.h"
#include "schedules/check/checker.h"
#include "schedules/file/inherit.h"
#include "schedules/synthesis/instants/judging/chain_ends.h"
#include "schedules/synthesis/instants/judging/moves.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::instants {
namespace {

using judging::chain_ends;
using judging::ChainEnd;
using judging::FirstUse;
using judging::Judge;
using judging::judged;
using judging::kMostMoves;
using judging::moved_measurements;
using judging::placed_within;
using judging::Prospect;
using judging::prospects;

using plan::Goal;
using plan::Plan;

Plan paper(const std::string& objectives, const std::string& cycles = "8535 us") {
  std::string text =
      changed(plan_text("paper"), "objective: \\[[^\\]]*\\]",
              "objective: [" + objectives + "]\n  error: {process_noise: 1, sigma: {laser: 1, camera: 1}}");
  text = changed(text, "cycle: \\{[^}]*\\}", "cycle: {shortest: 8535 us, longest: " + cycles + ", step: 5 us}");
  return plan::parse_plan(text, "plan.yaml");
}

// The age of a chain's measurement when it is first used.
Duration age_of(const std::vector<ChainEnd>& chain_ends, std::size_t chain) {
  for (const ChainEnd& chain_end : chain_ends)
    for (const FirstUse& one : chain_end.first_uses)
      if (one.chain == chain) return one.used - one.measured;
  return {};
}

// Wants the camera to be so much older than the laser, and both of them young.
// Its value is |camera - laser - apart| + laser / 1000, in us.
class WantsApart : public Judge {
 public:
  explicit WantsApart(std::vector<double> apart_us) : apart_us_(std::move(apart_us)) {}
  std::size_t parts() const override { return apart_us_.size(); }
  double of(const std::vector<ChainEnd>& chain_ends, const std::vector<double>& weights) const override {
    ++asked_;
    const double laser = 1e-3 * static_cast<double>(age_of(chain_ends, 0).ns);
    const double camera = 1e-3 * static_cast<double>(age_of(chain_ends, 1).ns);
    double most = 0.0;
    for (std::size_t i = 0; i < apart_us_.size(); ++i)
      most = std::max(most, weights[i] * (std::abs(camera - laser - apart_us_[i]) + laser / 1'000.0));
    return most;
  }
  double bound(const std::vector<Prospect>& prospects, const std::vector<double>& weights, double, int) const override {
    return *std::max_element(weights.begin(), weights.end()) *
           static_cast<double>(prospects.front().coming.front().least_age.ns) * 1e-6;
  }
  int asked() const { return asked_; }

 private:
  std::vector<double> apart_us_;
  mutable int asked_ = 0;
};

TEST(Judged, MeasurementsMoveToWhereTheJudgeWantsThem) {
  for (const double apart : {1'000.0, 3'777.0, -9'123.0}) {
    const WantsApart judge({apart});
    const Plan plan = paper("error");
    const Synthesis made = synthesize(plan, {{Goal::kError, &judge}});
    ASSERT_TRUE(made.found);
    EXPECT_TRUE(check::check(made.cluster).empty());
    const auto ends = chain_ends(plan, made.cluster);
    EXPECT_NEAR(1e-3 * static_cast<double>((age_of(ends, 1) - age_of(ends, 0)).ns), apart, 1.0);
    EXPECT_EQ(made.reached[0].value, judge.of(ends, {1.0}));
    EXPECT_LE(made.reached[0].bound, made.reached[0].value);
  }
}

// The steps are counted: a judge is asked a bounded number of times.
TEST(Judged, AsksABoundedNumberOfTimes) {
  const WantsApart judge({3'777.0});
  (void)synthesize(paper("error"), {{Goal::kError, &judge}});
  EXPECT_GT(judge.asked(), 20);
  EXPECT_LT(judge.asked(), kMostMoves + 40);
}

// Two wishes: each one alone is met, and both together are met half. The regret weighs them by their least values.
TEST(Judged, RegretLiesBetweenTheWishes) {
  const WantsApart both({1'000.0, 5'000.0});
  const Plan plan = paper("error");
  const Synthesis made = synthesize(plan, {{Goal::kError, &both}});
  ASSERT_TRUE(made.found);
  const auto& weights = made.reached[0].weights;
  ASSERT_EQ(weights.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const WantsApart alone({i == 0 ? 1'000.0 : 5'000.0});
    EXPECT_NEAR(1.0 / weights[i], synthesize(plan, {{Goal::kError, &alone}}).reached[0].value, 0.01);
  }
  const auto ends = chain_ends(plan, made.cluster);
  EXPECT_NEAR(1e-3 * static_cast<double>((age_of(ends, 1) - age_of(ends, 0)).ns), 3'000.0, 25.0);
}

TEST(Judged, LaterObjectivesKeepTheValue) {
  const WantsApart judge({3'777.0});
  const Plan plan = paper("error, slots, worst_age, jitter, room", "8560 us");
  const Synthesis made = synthesize(plan, {{Goal::kError, &judge}});
  ASSERT_TRUE(made.found);
  EXPECT_EQ(made.reached[0].value, judged(judge, {1.0}, plan, made.cluster));
  EXPECT_EQ(made.reached[0].value, synthesize(paper("error", "8560 us"), {{Goal::kError, &judge}}).reached[0].value);
}

TEST(Judged, EarlierObjectivesAreKept) {
  const WantsApart judge({3'777.0});
  const Synthesis ages = synthesize(paper("worst_age"));
  const Synthesis made = synthesize(paper("worst_age, error"), {{Goal::kError, &judge}});
  ASSERT_TRUE(made.found);
  EXPECT_EQ(made.reached[0].value, ages.reached[0].value);
  EXPECT_TRUE(made.reached[0].proven);
}

// A plan of which no instants are possible has no value, and is proven to have none.
TEST(Judged, WithoutInstantsThereIsNoValue) {
  std::string text = changed(plan_text("paper"), "objective: \\[[^\\]]*\\]",
                             "objective: [error]\n  error: {process_noise: 1, sigma: {laser: 1, camera: 1}}");
  text = changed(text, "from: laser, to: feature.use, largest_age: 60 ms",
                 "from: laser, to: feature.use, largest_age: 50 ms");
  const WantsApart judge({0.0});
  const Synthesis made = synthesize(plan::parse_plan(text, "plan.yaml"), {{Goal::kError, &judge}});
  EXPECT_FALSE(made.found);
  EXPECT_TRUE(made.exact);
}

// A cluster has the meetings of the offsets that it was made from.
TEST(ChainEnds, AreThoseOfTheProblem) {
  const Plan plan = paper("worst_age");
  const auto read = read_of(plan, candidates(plan)[0]);
  const Search found = place(read->reading, {});
  ASSERT_TRUE(found.best);
  const model::Cluster cluster = with_instants(plan, read->timed, read->reading, found.best->solution);
  EXPECT_EQ(offsets_of(*read, cluster), found.best->solution.offsets);
  const auto by_cluster = chain_ends(plan, cluster);
  const auto by_problem =
      chain_ends(plan, read->reading.problem, cluster.flexray.gdMacrotick_ps, found.best->solution.offsets);
  ASSERT_EQ(by_cluster.size(), 1u);
  ASSERT_EQ(by_cluster[0].first_uses.size(), 2u);
  EXPECT_EQ(by_cluster[0].round, Duration::microseconds(34'140));
  EXPECT_EQ(by_cluster[0].uses, by_problem[0].uses);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(by_cluster[0].first_uses[i].measured, by_problem[0].first_uses[i].measured);
    // The longest way of the chain, in macroticks of 1 us.
    const FirstUse& one = by_cluster[0].first_uses[i];
    EXPECT_EQ((one.used - one.measured).ns, found.best->ages[one.chain] * 1'000);
  }
}

// So it is where the payload is free: lists take other slots with each payload.
TEST(ChainEnds, AreThoseOfThePayloadThatWasChosen) {
  std::string text = changed(file::inherited(plan_path("paper_payload")).text, "shortest: 8.5 ms", "shortest: 8.6 ms");
  text = changed(text, "longest: 9 ms", "longest: 8.6 ms");
  text = changed(text, "payload: \\{[^}]*\\}", "payload: {shortest: 60, longest: 120, step: 20}");
  const Plan plan = plan::parse_plan(text, "plan.yaml");
  int placed = 0;
  for (const Candidate& candidate : candidates(plan)) {
    const auto read = read_of(plan, candidate);
    if (!read) continue;
    for (Ticks slots = least_slots(*read); slots <= read->timed.cluster.flexray.gNumberOfStaticSlots; slots += 10) {
      Limits limits;
      limits.last_slot = slots * read->timed.cluster.flexray.gdStaticSlot;
      const Search found = place(read->reading, limits, true);
      if (!found.best) continue;
      ++placed;
      const model::Cluster cluster = with_instants(plan, read->timed, read->reading, found.best->solution);
      const std::vector<ChainEnd> ends = chain_ends(plan, cluster);
      ASSERT_EQ(ends.size(), 1u);
      for (const FirstUse& one : ends[0].first_uses)
        EXPECT_EQ((one.used - one.measured).ns, found.best->ages[one.chain] * 1'000) << candidate.payload << " bytes";
    }
  }
  EXPECT_GT(placed, 10);
}

// Every placement that the search finds has ages that the prospect allows.
TEST(Prospects, AllowEveryPlacement) {
  const Plan plan = paper("worst_age", "8600 us");
  for (const Candidate& candidate : candidates(plan)) {
    const auto read = read_of(plan, candidate);
    const auto all = prospects(plan, read->reading, {}, read->timed.cluster.flexray.gdMacrotick_ps);
    ASSERT_EQ(all.size(), 1u);
    for (const Ticks more : {0, 9'000, 19'000, 29'000}) {  // the camera counts as so much older
      Limits limits;
      limits.beyond = {0, more};
      const Search found = place(read->reading, limits);
      ASSERT_TRUE(found.best);
      std::vector<Duration> ages;
      for (const Ticks age : found.best->ages) ages.push_back(Duration::microseconds(age));
      EXPECT_TRUE(all[0].attainable(ages, ages)) << more;
      EXPECT_LE(all[0].least_worst_age, *std::max_element(ages.begin(), ages.end()));
      for (std::size_t c = 0; c < 2; ++c) EXPECT_LE(all[0].coming[c].least_age, ages[c]);
    }
    // No instants bring both to their least ages: one task waits for the other.
    const std::vector<Duration> least{all[0].coming[0].least_age, all[0].coming[1].least_age};
    EXPECT_FALSE(all[0].attainable(least, least));
  }
}

// One processor fuses four lists, for 2 ms each.
class FourLists : public testing::Test {
 protected:
  FourLists()
      : plan_(plan::load_plan(plan_path("paper_two_lasers_radar"))), read_(*read_of(plan_, candidates(plan_)[7])) {
    all_ = prospects(plan_, read_.reading, {}, read_.timed.cluster.flexray.gdMacrotick_ps);
  }

  const Prospect& prospect() const { return all_.front(); }

  // Whether each list can wait for the fusions of all newer ones.
  bool can_be(const std::vector<Duration>& ages, Duration fusion) const {
    for (std::size_t i = 0; i < ages.size(); ++i) {
      std::int64_t newer = 0;
      for (const Duration other : ages) newer += other < ages[i] ? 1 : 0;
      if (ages[i] < prospect().coming[i].least_age + fusion * newer) return false;
    }
    return true;
  }

  Plan plan_;
  Read read_;
  std::vector<Prospect> all_;
};

TEST_F(FourLists, AllowEveryPlacement) {
  for (const std::vector<Ticks>& beyond : {std::vector<Ticks>{0, 0, 0, 0},
                                           {0, 18'000, 0, 35'000},
                                           {0, 37'000, 0, 71'000},
                                           {0, 18'000, 34'000, 35'000},
                                           {0, 50'000, 0, 18'000}}) {
    Limits limits;
    limits.beyond = beyond;
    const Search found = place(read_.reading, limits, false, 20'000);
    ASSERT_TRUE(found.best);
    std::vector<Duration> ages;
    for (const Ticks age : found.best->ages) ages.push_back(Duration::microseconds(age));
    EXPECT_TRUE(prospect().attainable(ages, ages));
    // The oracle of the next test says the same.
    EXPECT_TRUE(can_be(ages, Duration::milliseconds(2)));
  }
}

// Waits are counted one by one. Slots and clocks may decide within 20 us; those draws are left out.
TEST_F(FourLists, RuleOutAgesThatWaitTooShort) {
  RandomStream draws({41});
  int ruled_out = 0, allowed = 0;
  for (int draw = 0; draw < 4'000; ++draw) {
    std::vector<Duration> ages;
    for (const auto& one : prospect().coming)
      ages.push_back(one.least_age + Duration{draws.integer(0, draws.integer(0, 1) == 0 ? 8'000'000 : 34'000'000)});
    // The plan's largest age.
    for (const std::size_t c : {0, 1}) ages[c] = std::min(ages[c], Duration::milliseconds(64));
    const bool answer = prospect().attainable(ages, ages);
    if (can_be(ages, Duration::microseconds(2'030))) {
      EXPECT_TRUE(answer) << draw;
      ++allowed;
    } else if (!can_be(ages, Duration::microseconds(1'990))) {
      EXPECT_FALSE(answer) << draw;
      ++ruled_out;
    }
  }
  EXPECT_GT(ruled_out, 1'000);
  EXPECT_GT(allowed, 300);
}

TEST(Moves, KeepLimitsAndOrder) {
  const Plan plan = paper("worst_age");
  const auto read = read_of(plan, candidates(plan)[0]);
  const Reading& reading = read->reading;
  const Search found = place(reading, {});
  ASSERT_TRUE(found.best);
  EXPECT_TRUE(placed_within(reading, {}, found.best->solution.offsets));
  // The camera is fused first. Measured later than the laser, it would be out of order.
  std::vector<Ticks> later = found.best->solution.offsets;
  const std::size_t camera = *reading.sensors[1];
  later[camera] = (later[camera] + 3'000) % reading.problem.activities[camera].period;
  EXPECT_FALSE(placed_within(reading, {}, later));
  Limits limits;
  limits.largest_ages = {found.best->ages[0], found.best->ages[1] - 1};
  EXPECT_FALSE(placed_within(reading, limits, found.best->solution.offsets));
  // With nothing to gain, nothing moves.
  int moves = 0;
  const Placed same = moved_measurements(
      reading, {}, *found.best, [](const auto&) { return 1.0; }, 50, moves);
  EXPECT_EQ(same.solution.offsets, found.best->solution.offsets);
  EXPECT_LE(moves, 50);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::instants
