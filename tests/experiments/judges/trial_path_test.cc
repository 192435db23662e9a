// Bounds by one path: against the error of known instants, and of all instants in windows.
#include "experiments/judges/trial_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace ttf::experiments::judges {
namespace {

double log_uniform(RandomStream& draws, double low, double high) { return low * std::pow(high / low, draws.uniform()); }

Motion drawn_motion(RandomStream& draws) {
  return draws.integer(0, 2) == 0 ? Motion::kRandomWalk : Motion::kConstantVelocity;
}

TEST(TrialPath, OfKnownInstantsHasTheErrorItself) {
  RandomStream draws({31});
  for (int draw = 0; draw < 200; ++draw) {
    Round round{Duration::milliseconds(draws.integer(20, 80)), {}, {}, {draws.integer(0, 1) * 30'000'000}};
    const auto sensors = draws.integer(1, 4), uses = draws.integer(1, 3);
    for (int s = 0; s < sensors; ++s) {
      const Duration measured{draws.integer(0, round.length.ns - 1)};
      round.sightings.push_back(
          {measured, log_uniform(draws, 1e-4, 1.0), measured + Duration{draws.integer(0, 3 * round.length.ns)}, {}});
    }
    for (int u = 0; u < uses; ++u) round.uses.push_back({draws.integer(0, round.length.ns - 1)});
    const double density = log_uniform(draws, 0.01, 30.0);
    const Motion motion = drawn_motion(draws);
    EXPECT_NEAR(bounded_mean_error(round, motion, density) / mean_error(round, motion, density), 1.0, 1e-6) << draw;
  }
}

TEST(TrialPath, BoundsAllInstantsInWindows) {
  RandomStream draws({21});
  for (int draw = 0; draw < 600; ++draw) {
    const std::int64_t length = draws.integer(20'000'000, 80'000'000);
    Round box{{length}, {}, {Duration{}}, {draws.integer(0, 1) * length}}, inside = box;
    const auto sensors = draws.integer(1, 3);
    for (int s = 0; s < sensors; ++s) {
      const Duration within{draws.integer(1, length)};
      const Duration age{draws.integer(within.ns, 2 * length)};
      const double variance = log_uniform(draws, 1e-8, 1e6);  // all that a plan may say
      box.sightings.push_back({Duration{} - age, variance, Duration{} - within, within});
      inside.sightings.push_back({Duration{} - age + Duration{draws.integer(0, within.ns)}, variance, {}, {}});
    }
    const double density = log_uniform(draws, 1e-6, 1e6);
    for (const Motion motion : {Motion::kConstantVelocity, Motion::kRandomWalk})
      EXPECT_LE(bounded_mean_error(box, motion, density), mean_error(inside, motion, density)) << draw;
  }
}

// Two sensors at any phase, without boxes: the oracle is a grid of phases.
TEST(TrialPath, OfWholePeriodsIsCloseToTheLeastPhases) {
  RandomStream draws({32});
  constexpr int kGrid = 16;
  for (int draw = 0; draw < 60; ++draw) {
    const Duration period = Duration::milliseconds(draws.integer(20, 60));
    Round all{period, {}, {Duration{}}, period * draws.integer(0, 1)};
    for (int s = 0; s < 2; ++s) {
      const Duration oldest = Duration::milliseconds(draws.integer(0, 90)) + period - Duration{1};
      const Duration known = Duration{1} - period;
      all.sightings.push_back({Duration{} - oldest, log_uniform(draws, 1e-4, 1.0), known, period - Duration{1}});
    }
    const double density = log_uniform(draws, 0.01, 30.0);
    const Motion motion = drawn_motion(draws);
    double least = 1e9;
    for (int cell = 0; cell < kGrid * kGrid; ++cell) {
      Round one = all;
      for (std::size_t s = 0; s < 2; ++s) {
        const int newer = s == 0 ? cell / kGrid : cell % kGrid;
        one.sightings[s].measured += Duration{(period.ns - 1) * newer / (kGrid - 1)};
        one.sightings[s].known = Duration{};
        one.sightings[s].within = Duration{};
      }
      least = std::min(least, mean_error(one, motion, density));
    }
    const double bound = bounded_mean_error(all, motion, density);
    EXPECT_LE(bound, least) << draw;
    EXPECT_GT(bound, 0.98 * least) << draw;
  }
}

}  // namespace
}  // namespace ttf::experiments::judges
