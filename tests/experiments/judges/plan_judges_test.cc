// The objectives error and gap_error of the shipped plans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "experiments/judges/error_judge.h"
#include "experiments/judges/gap_judge.h"
#include "experiments/sweep/expected_error.h"
#include "schedules/analysis/ages.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/check/checker.h"
#include "schedules/exchange/cluster_yaml.h"
#include "schedules/synthesis/instants/judging/chain_ends.h"
#include "schedules/synthesis/instants/judging/moves.h"
#include "schedules/synthesis/instants/placement.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/synthesis/plans.h"

namespace ttf::experiments::judges {
namespace {

namespace instants = schedules::synthesis::instants;
namespace judging = schedules::synthesis::instants::judging;
using instants::Reached;
using instants::Synthesis;
using schedules::synthesis::plan::Goal;
using schedules::synthesis::plan::Plan;

constexpr const char* kSigmas = "sigma: {laser: 0.06, camera: 0.15}";

// The paper's plan for one length of the cycle, or for some, with the objectives and the sections that they need.
Plan paper(const std::string& objectives, const std::string& sections, const std::string& cycles = "8535 us") {
  std::string text = schedules::synthesis::plan_text("paper");
  text =
      schedules::synthesis::changed(text, "objective: \\[[^\\]]*\\]", "objective: [" + objectives + "]\n" + sections);
  const std::string range = "cycle: {shortest: 8535 us, longest: " + cycles + ", step: 5 us}";
  return schedules::synthesis::plan::parse_plan(schedules::synthesis::changed(text, "cycle: \\{[^}]*\\}", range),
                                                "plan");
}

std::string error_of(const std::string& noise) { return "  error: {" + std::string(kSigmas) + ", " + noise + "}"; }

Synthesis made_of(const Plan& plan) {
  const GapJudge gap_error(plan);
  judging::Judges judges{{Goal::kGapError, &gap_error}};
  std::optional<ErrorJudge> error;
  if (plan.error) judges[Goal::kError] = &error.emplace(plan);
  Synthesis made = instants::synthesize(plan, judges);
  EXPECT_TRUE(made.found);
  EXPECT_TRUE(schedules::check::check(made.cluster).empty());
  return made;
}

double error_at(const Plan& plan, const schedules::model::Cluster& cluster) {
  return judging::judged(ErrorJudge(plan), {1.0}, plan, cluster);
}

// The error at use of a cluster, by the nominal ages of `schedule check` and the recursion list by list.
double error_by_lists(const schedules::model::Cluster& cluster, double density) {
  const auto clocks = schedules::analysis::clock_bounds(cluster);
  const std::int64_t period = cluster.sensors[0].period.ns;
  std::vector<sweep::Look> looks;
  constexpr int kPeriods = 400;
  for (const auto& path : schedules::analysis::measurement_ages(cluster)) {
    const double sigma = cluster.sensor(path.sensor).name == "laser" ? 0.06 : 0.15;
    // Without the differences of clocks (schedules/analysis/ages.h, A2), to the next macrotick.
    std::int64_t age = path.use_worst.ns - clocks.apart_ns;
    age = (age - clocks.drift_ns(age)) / 1'000 * 1'000;
    for (int n = 0; n < kPeriods; ++n)
      looks.push_back({GlobalTime{n * period - age}, sigma * sigma * Eigen::Matrix2d::Identity()});
  }
  std::stable_sort(looks.begin(), looks.end(), [](const auto& a, const auto& b) { return a.measured < b.measured; });
  sweep::ErrorRecursion recursion(sweep::PointMotion::known(density, 10.0));
  for (const sweep::Look& look : looks) recursion.fuse(look);
  return recursion.at(GlobalTime{(kPeriods - 1) * period})(0, 0);
}

TEST(ErrorOfAPlan, IsThatOfTheClusterByItsLists) {
  for (const char* noise : {"0.01", "1", "25"}) {
    const Plan plan = paper("error", error_of("process_noise: " + std::string(noise)));
    const Synthesis made = made_of(plan);
    const Reached& error = made.reached[0];
    EXPECT_DOUBLE_EQ(error.value, error_at(plan, made.cluster));
    EXPECT_NEAR(error.value / error_by_lists(made.cluster, plan.error->process_noises[0]), 1.0, 1e-4) << noise;
    EXPECT_LE(error.bound, error.value);
    EXPECT_GT(error.bound, 0.998 * error.value);
  }
}

// No cluster that is best for another objective has a smaller error. None has one whose sensors measure at other
// instants.
TEST(ErrorOfAPlan, NoOtherInstantsAreBetter) {
  const Plan plan = paper("error", error_of("process_noise: 1"), "8600 us");
  const Synthesis made = made_of(plan);
  for (const char* objectives : {"worst_age", "data_age, worst_age, slots", "jitter", "slots", "gap_error"}) {
    const Plan other = paper(objectives, error_of("process_noise: 1"), "8600 us");
    EXPECT_LE(made.reached[0].value, error_at(other, made_of(other).cluster)) << objectives;
  }
  RandomStream draws({31});
  for (int draw = 0; draw < 300; ++draw) {
    schedules::model::Cluster moved = made.cluster;
    for (auto& sensor : moved.sensors) {
      const std::int64_t at = draws.integer(0, sensor.at.repetition * moved.flexray.gMacroPerCycle - 1);
      sensor.at.base_cycle = static_cast<int>(at / moved.flexray.gMacroPerCycle);
      sensor.at.offset = Macroticks{at % moved.flexray.gMacroPerCycle};
    }
    EXPECT_LE(made.reached[0].value, error_at(plan, moved) * (1.0 + 1e-12));
  }
}

// The least worst age gives error away: it fuses the camera first, and so the camera measures as early as the laser.
TEST(ErrorOfAPlan, TheLeastWorstAgeGivesErrorAway) {
  for (const auto& [noise, least_loss, most_loss] :
       {std::tuple{"0.01", 0.003, 0.005}, std::tuple{"1", 0.015, 0.019}, std::tuple{"25", 0.05, 0.06}}) {
    const std::string section = error_of("process_noise: " + std::string(noise));
    const double least = made_of(paper("error", section)).reached[0].value;
    const Synthesis by_age = made_of(paper("data_age, worst_age, error", section));
    const double loss = by_age.reached[2].value / least - 1.0;
    EXPECT_GT(loss, least_loss) << noise;
    EXPECT_LT(loss, most_loss) << noise;
    // Objectives before it keep their values.
    const Synthesis ages = made_of(paper("data_age, worst_age", section));
    EXPECT_EQ(by_age.reached[0].value, ages.reached[0].value);
    EXPECT_EQ(by_age.reached[1].value, ages.reached[1].value);
    EXPECT_TRUE(by_age.reached[0].proven && by_age.reached[1].proven);
  }
}

// Far ahead the laser alone counts. The plan for a car close by then has more error than the one with the least ages,
// as in drives (docs/schedules/synthesis.md).
TEST(ErrorOfAPlan, SigmaDecides) {
  const auto far = [](const std::string& noise) {
    return "  error: {sigma: {laser: 0.0106, camera: 1.7}, process_noise: " + noise + "}";
  };
  const Synthesis close_by = made_of(paper("error", error_of("process_noise: 1")));
  const Synthesis by_age = made_of(paper("data_age, worst_age", ""));
  for (const auto& [noise, loss] : {std::pair{"1", 0.055}, std::pair{"25", 0.086}}) {
    const Plan plan = paper("error", far(noise));
    const double of_ages = error_at(plan, by_age.cluster);
    EXPECT_NEAR(error_at(plan, close_by.cluster) / of_ages - 1.0, loss, 6e-4) << noise;
    const double least = made_of(plan).reached[0].value;
    EXPECT_LE(least, of_ages * (1.0 + 1e-12));
    EXPECT_GT(least, of_ages * 0.998);
  }
}

// The mean over uses falls if there are fewer of them; that over time does not.
TEST(ErrorOfAPlan, OverTimeMoreMeasurementsAreBetter) {
  for (const bool over_time : {false, true}) {
    std::string text = schedules::synthesis::plan_text("paper");
    const std::string over = over_time ? "process_noise: 1, over: time" : "process_noise: 1";
    text = schedules::synthesis::changed(text, "objective: \\[[^\\]]*\\]", "objective: [error]\n" + error_of(over));
    text = schedules::synthesis::changed(text, "cycle: \\{[^}]*\\}",
                                         "cycle: {shortest: 8.5 ms, longest: 8.5 ms, step: 5 us}");
    text =
        schedules::synthesis::changed(text, "laser: \\{shortest: [^}]*\\}", "laser: {shortest: 60 ms, longest: 80 ms}");
    text = schedules::synthesis::changed(text, "camera: \\{shortest: [^}]*\\}",
                                         "camera: {shortest: 30 ms, longest: 80 ms}");
    text = schedules::synthesis::changed(text, ", largest_age: 60 ms\\}\n    camera", "}\n    camera");
    const Synthesis made = made_of(schedules::synthesis::plan::parse_plan(text, "plan"));
    EXPECT_EQ(made.cluster.sensors[0].period, Duration::milliseconds(68));
    EXPECT_EQ(made.cluster.sensors[1].period, Duration::milliseconds(over_time ? 34 : 68));
    EXPECT_LE(made.reached[0].bound, made.reached[0].value);
    EXPECT_GT(made.reached[0].bound, 0.95 * made.reached[0].value);
  }
}

// Lists are fused one after the other. So each order of them has its least ages. All orders are tried.
TEST(ErrorOfFourSensors, IsThatOfTheBestOrder) {
  // As paper_two_lasers_radar.yaml.
  const Plan plan = paper("error",
                          "  sensors: {rear_laser: {like: laser}, front_radar: {like: laser, kind: radar, raw: 32, "
                          "objects: 12, preprocessing: 14 ms}}\n"
                          "  error: {process_noise: 1, sigma: {laser: 0.06, camera: 0.15, front_radar: 0.25}}");
  const Synthesis made = made_of(plan);
  const auto read = instants::read_of(plan, made.candidate);
  const auto prospect = judging::prospects(plan, read->reading, {}, 1'000'000).front();
  const double variances[] = {0.06 * 0.06, 0.15 * 0.15, 0.06 * 0.06, 0.25 * 0.25};
  double least = 1e9;
  std::vector<std::size_t> order{0, 1, 2, 3};  // the newest first
  do {
    Round round{prospect.every, {}, {Duration{}}, {}};
    Duration age{}, wait = Duration::microseconds(40);  // to the next slot
    for (const std::size_t list : order) {
      age = std::max(age + Duration::microseconds(10), prospect.coming[list].least_age + wait);
      round.sightings.push_back({Duration{} - age, variances[list], {}, {}});
      wait += Duration::microseconds(2'020);
    }
    least = std::min(least, mean_error(round, Motion::kConstantVelocity, 1.0));
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_NEAR(made.reached[0].value / least, 1.0, 5e-4);
  EXPECT_LE(made.reached[0].bound, made.reached[0].value);
  EXPECT_GT(made.reached[0].bound, 0.9975 * made.reached[0].value);
}

// A cluster with odometry, which measures no object.
TEST(ErrorOfAPlan, OdometryDoesNotCount) {
  const std::string text = schedules::synthesis::without_instants(schedules::shipped_text("moving_synchronised")) +
                           "\nplan:\n  objective: [error, gap_error]\n" + error_of("process_noise: 1") + "\n";
  const Plan plan = schedules::synthesis::plan::parse_plan(text, "plan");
  EXPECT_TRUE(std::any_of(plan.chains.begin(), plan.chains.end(), [&](const auto& chain) {
    return plan.cluster.sensor(chain.from).kind == schedules::model::SensorKind::kOdometry;
  }));
  const Synthesis made = made_of(plan);
  for (const auto& chain_end : judging::chain_ends(plan, made.cluster))
    for (const auto& one : chain_end.first_uses)
      EXPECT_NE(plan.cluster.sensor(plan.chains[one.chain].from).kind, schedules::model::SensorKind::kOdometry);
  EXPECT_GT(made.reached[0].value, 0.0);
  EXPECT_LE(made.reached[0].bound, made.reached[0].value);
  EXPECT_LE(made.reached[1].bound, made.reached[1].value);
}

TEST(ErrorOfAPlan, ObjectivesBehindItKeepIt) {
  const std::string section = error_of("process_noise: 1");
  const double least = made_of(paper("error", section)).reached[0].value;
  const Plan plan = paper("error, slots, worst_age, room, jitter, gap_error", section);
  const Synthesis made = made_of(plan);
  ASSERT_EQ(made.reached.size(), 6u);
  EXPECT_DOUBLE_EQ(made.reached[0].value, least);
  EXPECT_DOUBLE_EQ(error_at(plan, made.cluster), least);
  for (const Reached& one : made.reached) {
    if (one.goal == Goal::kRoom)
      EXPECT_GE(one.bound, one.value);
    else
      EXPECT_LE(one.bound, one.value) << name_of(one.goal);
  }
  // Fewer slots are possible, with another error. So nothing is proven about slots.
  EXPECT_FALSE(made.reached[1].proven);
}

// The least gap error of the plan without the first judge is known.
TEST(SecondJudge, HasTheBoundOfThePlanWithoutTheFirst) {
  const std::string section = error_of("process_noise: 1");
  const Synthesis alone = made_of(paper("gap_error", section, "8560 us"));
  const Synthesis behind = made_of(paper("error, gap_error", section, "8560 us"));
  EXPECT_DOUBLE_EQ(behind.reached[1].bound, alone.reached[0].value);
  EXPECT_GT(behind.reached[1].value, 1.001 * behind.reached[1].bound);
  EXPECT_LT(behind.reached[1].value, 1.01 * behind.reached[1].bound);
  EXPECT_FALSE(behind.reached[1].supposes.empty());
  // Ages that were held before both judges count for the bound, too.
  const Synthesis aged = made_of(paper("data_age, worst_age, error, gap_error", section, "8560 us"));
  EXPECT_EQ(aged.reached[3].bound, aged.reached[3].value);
}

// Measurements are moved on a grid. No error there is below the bound of the second judge.
TEST(SecondJudge, BoundsAllMovesOfMeasurements) {
  const Plan plan = paper("gap_error, error", error_of("process_noise: 5"));
  const Synthesis made = made_of(plan);
  const auto read = instants::read_of(plan, made.candidate);
  const instants::Search found = instants::place(read->reading, {});
  ASSERT_TRUE(found.best);
  const ErrorJudge error(plan);
  double least = 1e9;
  const auto& sensors = read->reading.sensors;
  for (schedules::synthesis::Ticks laser = 0; laser < 34'140; laser += 500)
    for (schedules::synthesis::Ticks camera = 0; camera < 34'140; camera += 500) {
      auto offsets = found.best->solution.offsets;
      offsets[*sensors[0]] = (offsets[*sensors[0]] + laser) % 34'140;
      offsets[*sensors[1]] = (offsets[*sensors[1]] + camera) % 34'140;
      const auto placed = judging::placed_within(read->reading, {}, offsets);
      if (placed)
        least = std::min(
            least,
            error.of(judging::chain_ends(plan, read->reading.problem, 1'000'000, placed->solution.offsets), {1.0}));
    }
  EXPECT_LE(made.reached[1].bound, least);
  EXPECT_LE(made.reached[1].bound, made.reached[1].value);
  EXPECT_GT(made.reached[1].bound, 0.95 * made.reached[1].value);
}

// The regret is 1 only if one schedule is the best for all densities, and each part is weighed by its own least error.
TEST(Regret, WeighsEachDensityByItsLeastError) {
  const Synthesis made = made_of(paper("error", error_of("process_noises: [0.01, 1, 25]")));
  const Reached& regret = made.reached[0];
  ASSERT_EQ(regret.weights.size(), 3u);
  EXPECT_GE(regret.value, 1.0);
  EXPECT_LE(regret.bound, regret.value);
  double worst = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const char* noises[] = {"0.01", "1", "25"};
    const Plan alone = paper("error", error_of("process_noise: " + std::string(noises[i])));
    const double least = made_of(alone).reached[0].value;
    EXPECT_DOUBLE_EQ(1.0 / regret.weights[i], least);
    worst = std::max(worst, error_at(alone, made.cluster) / least);
  }
  EXPECT_NEAR(regret.value, worst, 1e-12);
}

TEST(GapErrorOfAPlan, IsLeastAtTheLeastWorstAge) {
  const Plan plan = paper("gap_error", "", "8600 us");
  const Synthesis made = made_of(plan), by_age = made_of(paper("data_age, worst_age", "", "8600 us"));
  const Reached& gap = made.reached[0];
  EXPECT_EQ(gap.value, gap.bound);
  EXPECT_FALSE(gap.proven);  // the bound has a condition
  EXPECT_FALSE(gap.supposes.empty());
  EXPECT_EQ(made.cluster.cycle(), by_age.cluster.cycle());
  EXPECT_DOUBLE_EQ(gap.value, judging::judged(GapJudge(plan), {1.0}, plan, by_age.cluster));
  // An age of 54.9 ms and a period of 34 ms lie between the rows of 40 ms and 80 ms of docs/schedules/expected_error.md.
  EXPECT_GT(std::sqrt(gap.value), 0.40);
  EXPECT_LT(std::sqrt(gap.value), 0.4359);
}

TEST(GapErrorOfAPlan, GrowsWithTheDelayBehindTheChain) {
  double before = 0.0;
  for (const char* delay : {"0 ms", "15 ms", "60 ms"}) {
    const double error =
        made_of(paper("gap_error", "  gap_error: {delay: " + std::string(delay) + "}")).reached[0].value;
    EXPECT_GT(error, before);
    before = error;
  }
}

TEST(PlanLeastError, IsCloseToItsBound) {
  const Plan plan = schedules::synthesis::plan::load_plan(schedules::synthesis::plan_path("paper_least_error"));
  const Synthesis made = made_of(plan);
  EXPECT_NEAR(made.reached[0].value, 1.0, 1e-12);  // one schedule is the best for all densities
  EXPECT_GT(made.reached[0].bound, 0.999);
}

TEST(PlanLeastError, IsTheSameEveryTime) {
  const Plan plan = paper("error", error_of("process_noises: [0.1, 5]"), "8560 us");
  const auto text = [&] { return schedules::exchange::cluster_yaml(made_of(plan).cluster, ""); };
  EXPECT_EQ(text(), text());
}

}  // namespace
}  // namespace ttf::experiments::judges
