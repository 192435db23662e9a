// Corrections of heading, front and sizes.
#include "fusion/tracks/parts/extents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "fusion/motion/angles.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

TEST(Extents, HeadingIsMeasuredUpToHalfATurnAndAveraged) {
  config::TrackerConfig config;
  config.heading_noise = config.initial_turn_rate_sigma = 0.0;
  config.extent_noise = 0.0;
  Bench bench(config);
  RandomStream stream({.seed = 8});
  double length_sum = 0.0;
  const int n = 200;
  for (int k = 0; k < n; ++k) {
    sensors::Observation z = position(20.0, 0.0, 0.1);
    z.has_heading = z.has_length = true;
    z.heading = motion::to_half_turn(3.1 + 0.05 * stream.normal() + (stream.uniform() < 0.5 ? 0.0 : std::numbers::pi));
    z.sigma_heading = 0.05;
    z.length = 4.0 + 0.3 * stream.normal();
    z.sigma_length = 0.3;
    length_sum += z.length;
    bench.step(50 * k, {z});
  }
  ASSERT_EQ(bench.set.tracks.size(), 1u);
  const Track& track = bench.set.tracks[0];
  const double off = motion::to_half_turn(track.heading.value - 3.1);
  EXPECT_LT(std::min(std::abs(off), std::numbers::pi - std::abs(off)), 4.0 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(track.heading.variance, 0.05 * 0.05 / n, 1e-12);
  EXPECT_NEAR(track.extent.size(0), length_sum / n, 0.9) << "most of the variance may be common";
  EXPECT_NEAR(track.extent.covariance(0, 0), 0.8 * 0.3 * 0.3, 0.02 * 0.3 * 0.3);
  EXPECT_FALSE(track.extent.length_is_measured()) << "hardly better than by the prior";
  EXPECT_FALSE(track.extent.width_is_measured());
}

// The first two positions show a car that backs, which is noise. Its axis is taken at the other end.
//
//   0 s          10 s            20 s
//   creeps with 0.5 m/s, stands
TEST(Extents, ACarThatCreptAndStandsFacesItsFront) {
  config::TrackerConfig config;
  config.process_noise = 0.002;
  config.gate_probability = 0.99999;  // no position is taken for another car
  Bench bench(config);
  RandomStream stream({.seed = 5});
  for (int k = 0; k < 400; ++k) {
    const double seconds = 0.05 * k;
    const double x = 20.0 + 0.5 * std::min(seconds, 10.0) + (k == 0 ? 0.2 : 0.05 * stream.normal());
    sensors::Observation z = position(x, 0.05 * stream.normal(), 0.05);
    z.has_heading = k > 1;
    z.heading = 0.02 * stream.normal();
    z.sigma_heading = 0.02;
    bench.step(50 * k, {z});
    ASSERT_EQ(bench.set.tracks.size(), 1u);
    const TrackView view = shown(bench.set.tracks[0], at_ms(50 * k), at_ms(50 * k), config);
    if (k < 2) continue;
    // While it faces backwards, it gives its front one chance in a hundred at least.
    ASSERT_TRUE(std::abs(view.heading) < 4.0 * view.sigma_heading || view.sigma_heading > 0.1 * std::numbers::pi)
        << seconds << " s, " << view.heading << ", " << view.sigma_heading;
    ASSERT_TRUE(view.sigma_heading < 0.05 || seconds < 5.0) << seconds << " s, " << view.sigma_heading;
  }
  EXPECT_GT(std::abs(bench.set.tracks[0].heading.value), 3.0) << "the axis was taken at the other end";
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
