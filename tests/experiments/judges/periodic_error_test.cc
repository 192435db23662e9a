// The periodic recursion: against closed forms, known tables, and the recursion list by list of experiments/sweep.
#include "experiments/judges/periodic_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "experiments/sweep/expected_error.h"

namespace ttf::experiments::judges {
namespace {

Duration seconds(double s) { return {std::llround(s * 1e9)}; }

// Two sensors that measure once in a period, the second one `lag` later: the mean over time of the predicted error.
// Between measurements it is a polynomial of the third degree, so Simpson's rule is exact.
double mean_over_time(Motion motion, double period, double lag, double first, double second, double density) {
  Round round{seconds(period), {{{}, first, {}, {}}, {seconds(lag), second, seconds(lag), {}}}, {}, {}};
  double sum = 0.0;
  for (const auto& [from, to] : {std::pair{Duration{}, seconds(lag)}, std::pair{seconds(lag), round.length}}) {
    if (from == to) continue;
    round.uses = {from, {(from.ns + to.ns) / 2}, to - Duration{1}};
    const std::vector<double> errors = errors_at_uses(round, motion, density);
    sum += (errors[0] + 4.0 * errors[1] + errors[2]) / 6.0 * (to - from).seconds();
  }
  return sum / period;
}

// p+ = (-qT + sqrt((qT)^2 + 4 qTR)) / 2, and the mean is p+ + qT / 2.
TEST(PeriodicError, OfARandomWalkHasItsClosedForm) {
  for (const double q : {0.1, 1.0, 7.0})
    for (const double r : {0.2, 1.0, 3.0}) {
      const Round round{seconds(1.0), {{{}, r, {}, {}}}, {Duration{}}, {}};
      EXPECT_NEAR(mean_error(round, Motion::kRandomWalk, q), (-q + std::sqrt(q * q + 4.0 * q * r)) / 2.0, 1e-12);
    }
}

TEST(PeriodicError, OfTwoSensorsOfAWalkIsTheKnownTable) {
  const std::pair<double, double> table[] = {{0.0, 0.866025}, {0.1, 0.826007}, {0.2, 0.793490}, {0.25, 0.780397},
                                             {0.3, 0.769556}, {0.4, 0.754922}, {0.5, 0.750000}};
  for (const auto& [lag, error] : table)
    EXPECT_NEAR(mean_over_time(Motion::kRandomWalk, 1.0, lag, 1.0, 1.0, 1.0), error, 6e-7) << lag;
  EXPECT_NEAR(mean_over_time(Motion::kRandomWalk, 1.0, 0.0, 1.0, 4.0, 1.0), 1.024695, 6e-7);
  EXPECT_NEAR(mean_over_time(Motion::kRandomWalk, 1.0, 0.55, 1.0, 4.0, 1.0), 0.959650, 6e-7);
}

// 0.55 is the best phase of the sensor with variance 4, to a hundredth.
TEST(PeriodicError, TheWorseSensorHasItsBestPhase) {
  double best = 1.0, at = 0.0;
  for (int hundredths = 0; hundredths < 100; ++hundredths) {
    const double error = mean_over_time(Motion::kRandomWalk, 1.0, hundredths / 100.0, 1.0, 4.0, 1.0);
    if (error < best) at = hundredths / 100.0;
    best = std::min(best, error);
  }
  EXPECT_NEAR(at, 0.55, 1e-9);
}

TEST(PeriodicError, OfTwoSensorsAtConstantVelocityIsTheKnownTable) {
  struct Row {
    double period, density, together, staggered, last_digit;
  };
  const Row table[] = {{0.04, 0.01, 7.535e-4, 7.525e-4, 1e-7},
                       {0.04, 1.0, 2.4238e-3, 2.3897e-3, 1e-7},
                       {0.04, 25.0, 5.853e-3, 5.446e-3, 1e-6},
                       {0.08, 1.0, 4.221e-3, 4.054e-3, 1e-6},
                       {0.08, 25.0, 1.1794e-2, 9.568e-3, 1e-6}};
  for (const Row& row : table) {
    const auto mean = [&](double lag) {
      return mean_over_time(Motion::kConstantVelocity, row.period, lag, 0.01, 0.01, row.density);
    };
    EXPECT_NEAR(mean(0.0), row.together, 0.6 * row.last_digit) << row.period << " " << row.density;
    EXPECT_NEAR(mean(row.period / 2.0), row.staggered, 0.6 * row.last_digit) << row.period << " " << row.density;
  }
  // The worst instant, just before a measurement.
  Round round{seconds(0.08), {{{}, 0.01, {}, {}}, {{}, 0.01, {}, {}}}, {seconds(0.08) - Duration{1}}, {}};
  EXPECT_NEAR(mean_error(round, Motion::kConstantVelocity, 25.0), 2.485e-2, 6e-6);
  round.sightings[1].measured = round.sightings[1].known = seconds(0.04);
  EXPECT_NEAR(mean_error(round, Motion::kConstantVelocity, 25.0), 1.446e-2, 6e-6);
}

Round drawn_round(RandomStream& draws) {
  Round round{Duration::milliseconds(draws.integer(20, 80)), {}, {}, {}};
  const auto sensors = draws.integer(1, 4);
  for (int s = 0; s < sensors; ++s) {
    const Duration measured{draws.integer(0, round.length.ns - 1)};
    round.sightings.push_back(
        {measured, 0.001 + draws.uniform(), measured + Duration{draws.integer(0, 3 * round.length.ns)}, {}});
  }
  const auto uses = draws.integer(1, 3);
  for (int u = 0; u < uses; ++u) round.uses.push_back({draws.integer(0, round.length.ns - 1)});
  return round;
}

// The recursion of experiments/sweep fuses all lists that a use rests on, one by one, from a poor beginning on. Lists of
// many rounds ago do not matter any more.
TEST(PeriodicError, IsThatOfAllListsThatTheUseRestsOn) {
  RandomStream draws({11});
  for (int draw = 0; draw < 40; ++draw) {
    const Round round = drawn_round(draws);
    const double density = std::exp(draws.uniform() * 6.0 - 2.0);
    const std::vector<double> errors = errors_at_uses(round, Motion::kConstantVelocity, density);
    for (std::size_t u = 0; u < round.uses.size(); ++u) {
      constexpr int kRounds = 400;
      const GlobalTime use{round.uses[u].ns + kRounds * round.length.ns};
      std::vector<sweep::Look> looks;
      for (int n = 0; n <= kRounds; ++n)
        for (const Sighting& one : round.sightings)
          if (const std::int64_t start = n * round.length.ns; one.known.ns + start <= use.ns)
            looks.push_back({GlobalTime{one.measured.ns + start}, one.variance * Eigen::Matrix2d::Identity()});
      std::stable_sort(looks.begin(), looks.end(),
                       [](const auto& a, const auto& b) { return a.measured < b.measured; });
      sweep::ErrorRecursion recursion(sweep::PointMotion::known(density, 10.0));
      for (const sweep::Look& look : looks) recursion.fuse(look);
      EXPECT_NEAR(errors[u] / recursion.at(use)(0, 0), 1.0, 1e-6) << "draw " << draw << ", use " << u;
    }
  }
}

// Over a time that ends before the next use: Simpson's rule over three uses that rest on the same.
TEST(PeriodicError, OverTimeIsTheMeanOfPredictions) {
  RandomStream draws({13});
  for (int draw = 0; draw < 50; ++draw) {
    Round round = drawn_round(draws);
    round.uses.resize(1);
    Round held = round;
    held.held = {draws.integer(1, round.length.ns)};
    for (const Motion motion : {Motion::kRandomWalk, Motion::kConstantVelocity}) {
      // The later uses have nothing new: each measurement is known as much later.
      double sum = 0.0;
      for (const auto& [share, weight] : {std::pair{0, 1.0}, std::pair{1, 4.0}, std::pair{2, 1.0}}) {
        Round later = round;
        const Duration by{held.held.ns / 2 * share};
        later.uses[0] += by;
        for (Sighting& one : later.sightings) one.known += by;
        sum += weight / 6.0 * mean_error(later, motion, 2.0);
      }
      EXPECT_NEAR(mean_error(held, motion, 2.0) / sum, 1.0, 1e-6);
    }
  }
}

// A filter with more data has no larger error: earlier lists, a smaller variance, a further sensor.
TEST(PeriodicError, DoesNotGrowWithKnowledge) {
  RandomStream draws({12});
  for (int draw = 0; draw < 200; ++draw) {
    const Round round = drawn_round(draws);
    const double error = mean_error(round, Motion::kConstantVelocity, 1.0);
    Round sooner = round, better = round, more = round;
    sooner.sightings.back().known = sooner.sightings.back().measured;
    better.sightings.back().variance *= 0.5;
    more.sightings.push_back({{draws.integer(0, round.length.ns - 1)}, 0.3, {}, {}});
    more.sightings.back().known = more.sightings.back().measured;
    for (const Round& known : {sooner, better, more})
      EXPECT_LE(mean_error(known, Motion::kConstantVelocity, 1.0), error * (1.0 + 1e-9));
  }
}

}  // namespace
}  // namespace ttf::experiments::judges
