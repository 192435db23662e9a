// The gap error under a schedule's instants: against the loop of docs/schedules/expected_error.md with its delays on a grid.
#include "experiments/judges/following.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/cost/timetable.h"
#include "tests/experiments/cost/loops.h"

namespace ttf::experiments::judges {
namespace {

CommandRound of_one_age(Duration period, Duration age) { return {period, {Duration{}}, {{age, Duration{}}}}; }

// The same cost by stages with delays of a grid.
TEST(GapError, OfOneAgeIsThatOfStages) {
  const FollowingVehicle vehicle;
  const cost::FollowingLoop loop{1.8, 0.2, 10.0, 8};
  for (const int periods : {0, 1, 3})
    for (const int grains : {0, 3, 6}) {
      const Duration age = Duration::milliseconds(40 * periods + 5 * grains);
      const double gap = cost::follow(periods, cost::constant_delay(grains), loop).gap_m;
      EXPECT_NEAR(std::sqrt(gap_error(vehicle, of_one_age(Duration::milliseconds(40), age))) / gap, 1.0, 1e-9);
    }
}

// docs/schedules/expected_error.md, "Age against jitter of a command": the column steady.
TEST(GapError, OfOneAgeIsThePagesColumn) {
  const std::pair<int, double> column[] = {{0, 0.4359}, {40, 0.4599}, {80, 0.4876}, {160, 0.5546}};
  for (const auto& [more, gap] : column)
    EXPECT_NEAR(std::sqrt(gap_error({}, of_one_age(Duration::milliseconds(40), Duration::milliseconds(55 + more)))),
                gap, 5e-5);
}

// Wherever the round begins, and over however many periods it is counted.
TEST(GapError, DoesNotDependOnTheBeginningOfTheRound) {
  const Duration period = Duration::microseconds(34'140);
  const double error = gap_error({}, of_one_age(period, Duration::microseconds(54'952)));
  for (const int ms : {1, 13, 34}) {
    const Duration start = Duration::milliseconds(ms);
    EXPECT_EQ(gap_error({}, {period, {start}, {{start + Duration::microseconds(54'952), start}}}), error);
  }
  const CommandRound twice{
      period * 2,
      {Duration{}, period},
      {{Duration::microseconds(54'952), Duration{}}, {period + Duration::microseconds(54'952), period}}};
  EXPECT_NEAR(gap_error({}, twice) / error, 1.0, 1e-10);
}

// A lag far below the period. A command that is given again changes nothing, but makes the steps short.
TEST(GapError, OfAShortLagIsThatOfShortSteps) {
  const Duration period = Duration::milliseconds(301), age = Duration::milliseconds(180);
  for (const double lag : {0.001, 0.004, 0.02}) {
    const FollowingVehicle vehicle{1.2, lag, 0.8, 1.0};
    CommandRound again = of_one_age(period, age);
    for (int ms = 1; ms < 301; ++ms) again.commands.push_back({age + Duration::milliseconds(ms), Duration{}});
    const double error = gap_error(vehicle, of_one_age(period, age));
    EXPECT_GT(error, 0.0);
    EXPECT_NEAR(gap_error(vehicle, again) / error, 1.0, 1e-9) << lag;
  }
}

TEST(GapError, GrowsWithAgeAndPeriod) {
  double before = 0.0;
  for (int ms = 0; ms <= 200; ms += 10) {
    const double error = gap_error({}, of_one_age(Duration::milliseconds(40), Duration::milliseconds(ms)));
    EXPECT_GT(error, before);
    EXPECT_GT(gap_error({}, of_one_age(Duration::milliseconds(80), Duration::milliseconds(ms))), error);
    before = error;
  }
}

// It need not grow: a long time gap and a long period bring the loop close to its limit.
TEST(GapError, MayFallWithTheAge) {
  const FollowingVehicle vehicle{7.254, 0.0088, 69.058, 1.0};
  const Duration period = Duration::microseconds(914'900);
  EXPECT_LT(gap_error(vehicle, of_one_age(period, Duration::milliseconds(90))),
            0.5 * gap_error(vehicle, of_one_age(period, Duration::microseconds(32'800))));
}

// x' = -x + w, sampled for nothing: the variance is 1/2. With x' = x + w there is none.
TEST(TimetableCost, OfANoisyIntegratorIsItsVariance) {
  for (const double rate : {-1.0, 1.0}) {
    cost::ControlLoop loop;
    loop.add_plant({cost::matrix(1, 1, {rate}), cost::matrix(1, 1, {1.0}), cost::matrix(1, 1, {1.0}), {}}, {1}, 1.0);
    loop.add_discrete(cost::gains({0.0}), {0});
    loop.add_cost(0, 1.0);
    const double cost = cost::timetable_cost(loop.flow(), 0.7, {{0.2, loop.executes({1})}});
    if (rate < 0.0)
      EXPECT_NEAR(cost, 0.5, 1e-12);
    else
      EXPECT_TRUE(std::isinf(cost));
  }
}

}  // namespace
}  // namespace ttf::experiments::judges
