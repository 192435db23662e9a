// The expected error of a heading: against closed forms, and against the tracker's heading on drawn axes.
#include "experiments/sweep/expected_heading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "fusion/tracks/body/heading.h"

namespace ttf::experiments::sweep {
namespace {

GlobalTime at_ms(int ms) { return GlobalTime{ms * 1'000'000LL}; }

TEST(ExpectedHeading, OfAStandingAxisItIsThatOfTheMean) {
  fusion::config::TrackerConfig tracker;
  tracker.heading_noise = tracker.initial_turn_rate_sigma = tracker.turn_noise = 0.0;
  HeadingRecursion recursion(tracker);
  EXPECT_FALSE(recursion.known());
  for (int n = 0; n < 10; ++n) recursion.see(at_ms(80 * n), 0.01, 10.0);
  const auto [believed, actual] = recursion.at(at_ms(2000), 10.0);
  EXPECT_NEAR(believed(0, 0), 0.001, 1e-12);
  EXPECT_NEAR(actual(0, 0), 0.001, 1e-12);
}

// The walk has the variance q between two axes of variance r. The gain settles at k^2 / (1 - k) = q / r. The true axis
// stands. Its error is r k / (2 - k).
TEST(ExpectedHeading, SettlesAtTheAlphaFilter) {
  fusion::config::TrackerConfig tracker;
  tracker.initial_turn_rate_sigma = tracker.turn_noise = 0.0;
  tracker.heading_noise = 0.005;
  HeadingRecursion recursion(tracker);
  const double r = 4e-4, ratio = 0.005 * 0.08 / r;
  for (int n = 0; n < 400; ++n) recursion.see(at_ms(80 * n), r, 10.0);
  const auto [believed, actual] = recursion.at(at_ms(80 * 399), 10.0);
  const double k = 0.5 * (std::sqrt(ratio * ratio + 4.0 * ratio) - ratio);
  EXPECT_NEAR(believed(0, 0), r * k, 1e-9);
  EXPECT_NEAR(actual(0, 0), r * k / (2.0 - k), 1e-9);
}

// 20,000 tracks, by kinds of turn rates. The margin is 3 %. Sampling takes 2 % of it.
TEST(ExpectedHeading, IsThatOfTheTrackersHeading) {
  struct Kind {
    double rate_sigma, turn_noise, speed;
  };
  for (const Kind kind : {Kind{0.3, 0.1, 10.0}, Kind{0.001, 1e-6, 10.0}, Kind{0.3, 8.0, 1.0}, Kind{0.3, 0.0, 10.0}}) {
    fusion::config::TrackerConfig tracker;
    tracker.initial_turn_rate_sigma = kind.rate_sigma;
    tracker.turn_noise = kind.turn_noise;
    constexpr int kLists = 20, kPeriod_ms = 80, kUse_ms = 30;
    const auto variance = [](int n) { return 4e-4 * (1.0 + 0.1 * n); };
    HeadingRecursion recursion(tracker);
    for (int n = 0; n < kLists; ++n) recursion.see(at_ms(kPeriod_ms * n), variance(n), kind.speed);
    const auto [believed, actual] = recursion.at(at_ms(kPeriod_ms * (kLists - 1) + kUse_ms), kind.speed);

    double square = 0.0, of_rate = 0.0;
    fusion::tracks::body::Heading heading;
    constexpr std::uint32_t kTracks = 20'000;
    for (std::uint32_t track = 0; track < kTracks; ++track) {
      RandomStream noise({9, track, Purpose::kTest, 1, 0});
      heading = fusion::tracks::body::unknown_heading(tracker);
      for (int n = 0; n < kLists; ++n) {
        if (n > 0) heading = fusion::tracks::body::predicted(heading, tracker, kind.speed, kPeriod_ms * 1e-3);
        const double sigma = std::sqrt(variance(n));
        fusion::tracks::body::correct(heading, sigma * noise.normal(), sigma, 0.0);
      }
      heading = fusion::tracks::body::predicted(heading, tracker, kind.speed, kUse_ms * 1e-3);
      square += heading.value * heading.value / kTracks;
      of_rate += heading.rate * heading.rate / kTracks;
    }
    EXPECT_NEAR(square / actual(0, 0), 1.0, 0.03) << kind.turn_noise;
    EXPECT_NEAR(of_rate / actual(1, 1), 1.0, 0.03) << kind.turn_noise;
    EXPECT_NEAR(heading.variance / believed(0, 0), 1.0, 1e-4) << kind.turn_noise;
    EXPECT_NEAR(heading.rate_variance / believed(1, 1), 1.0, 1e-4) << kind.turn_noise;
  }
}

}  // namespace
}  // namespace ttf::experiments::sweep
