// A track without further observations becomes less certain, is marked, and ends by the rule of given_up() in
// fusion/tracks/track.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "tests/fusion/drives.h"

namespace ttf::fusion::tracks {
namespace {

class Coasting : public testing::TestWithParam<strategies::StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, Coasting, testing::ValuesIn(strategies::kAllStrategies), name_of_strategy);

constexpr std::int64_t kLast = 760;  // [ms], of the newest measurement

// A car at 10 m/s, seen every 40 ms until kLast; then all lists cease. All are fused, under every strategy.
struct Drive {
  config::TrackerConfig config;
  std::unique_ptr<strategies::Strategy> strategy;
  std::vector<TrackView> shown;

  Drive(strategies::StrategyKind kind, const config::TrackerConfig& tracker)
      : config(tracker), strategy(make_strategy(kind, tracker, laser_and_camera())) {
    for (std::uint32_t k = 0; 40 * k <= kLast; ++k) {
      strategy->accept(list_of(1, k, at_ms(40 * k), {car(40 * k)}).view());
      strategy->fuse(at_ms(40 * k + 100));
    }
    EXPECT_EQ(held(*strategy), 0u);
  }
  static sensors::Observation car(std::int64_t ms) { return position(20.0 + 0.01 * static_cast<double>(ms), 1.0, 0.2); }
  std::optional<TrackView> at(GlobalTime t) {
    strategy->image(t, shown);
    EXPECT_LE(shown.size(), 1u);
    return shown.empty() ? std::nullopt : std::optional(shown[0]);
  }
};

// Against prediction by numerical integration, from the state at the newest measurement.
TEST_P(Coasting, CovarianceGrowsAsTheMotionModelSays) {
  for (const config::MotionModel motion :
       {config::MotionModel::kConstantVelocity, config::MotionModel::kConstantAcceleration}) {
    config::TrackerConfig config;
    config.motion = motion;
    config.delete_position_sigma = 100.0;
    Drive drive(GetParam(), config);
    const auto known = drive.at(at_ms(kLast));
    ASSERT_TRUE(known);
    double trace = known->covariance.trace();
    for (std::int64_t ms = 20; ms <= 1'000; ms += 20) {
      const auto view = drive.at(at_ms(kLast + ms));
      ASSERT_TRUE(view) << ms;
      EXPECT_GT(view->covariance.trace(), trace) << ms;
      trace = view->covariance.trace();
      const double dt = 1e-3 * static_cast<double>(ms);
      const estimators::Covariance f = transition(motion, dt);
      const estimators::Covariance expected =
          f * known->covariance * f.transpose() + driving_noise(motion, config.process_noise, dt);
      EXPECT_LT((view->covariance - expected).norm(), 1e-9 * expected.norm()) << ms;
      EXPECT_LT((view->state - f * known->state).norm(), 1e-9) << ms;
    }
  }
}

TEST_P(Coasting, IsMarkedAndEndsToTheNanosecond) {
  config::TrackerConfig config;
  config.delete_position_sigma = 100.0;
  Drive drive(GetParam(), config);
  const GlobalTime seen = at_ms(kLast);
  const auto coasting = [&](Duration silent) {
    const auto view = drive.at(seen + silent);
    EXPECT_TRUE(view) << silent.ns;
    return view && view->coasting;
  };
  EXPECT_FALSE(coasting(config.coast_after));
  EXPECT_TRUE(coasting(config.coast_after + Duration{1}));
  EXPECT_TRUE(coasting(config.delete_after));
  EXPECT_FALSE(drive.at(seen + config.delete_after + Duration{1}));

  // The account of the fusion instants agrees with the images.
  drive.strategy->fuse(seen + config.delete_after);
  EXPECT_EQ(drive.strategy->confirmed_count(), 1);
  EXPECT_EQ(drive.strategy->tracks().size(), 1u);
  drive.strategy->fuse(seen + config.delete_after + Duration{1});
  EXPECT_EQ(drive.strategy->confirmed_count(), 0);
  EXPECT_EQ(drive.strategy->tentative_count(), 0);
  EXPECT_TRUE(drive.strategy->tracks().empty());
  EXPECT_EQ(drive.strategy->newest_measured(), seen) << "and its age goes on growing";
}

// Too uncertain before it is too old: it ends as soon as the position's spread exceeds the limit.
TEST_P(Coasting, EndsWhenItsPositionIsTooUncertain) {
  config::TrackerConfig config;
  config.delete_position_sigma = 0.6;
  Drive drive(GetParam(), config);
  const auto known = drive.at(at_ms(kLast));
  ASSERT_TRUE(known);
  std::int64_t limit = 1;
  const auto sigma = [&](std::int64_t ms) {
    const double dt = 1e-3 * static_cast<double>(ms);
    const estimators::Covariance f = transition(config.motion, dt);
    const estimators::Covariance p =
        f * known->covariance * f.transpose() + driving_noise(config.motion, config.process_noise, dt);
    return std::sqrt(std::max(p(0, 0), p(1, 1)));
  };
  while (sigma(limit) <= config.delete_position_sigma) ++limit;
  ASSERT_GT(limit, 310);
  ASSERT_LT(limit, 1'000);
  EXPECT_TRUE(drive.at(at_ms(kLast + limit - 1)));
  EXPECT_FALSE(drive.at(at_ms(kLast + limit)));
}

// Lists come again after the track has ended. Their object is new, and becomes a track only after enough of
// them.
TEST_P(Coasting, AnEndedTrackDoesNotComeBack) {
  const config::TrackerConfig config;
  Drive drive(GetParam(), config);
  const TrackId old = drive.at(at_ms(kLast))->id;
  const std::int64_t again = kLast + 1'040;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::int64_t ms = again + 40 * k;
    EXPECT_FALSE(drive.at(at_ms(ms))) << k;
    drive.strategy->accept(list_of(1, 100 + k, at_ms(ms), {Drive::car(ms)}).view());
    drive.strategy->fuse(at_ms(ms + 100));
  }
  const auto born = drive.at(at_ms(again + 80));
  ASSERT_TRUE(born);
  EXPECT_NE(born->id, old);
}

// The same gap, a little shorter: the track takes the observation and is as certain as before.
TEST_P(Coasting, ATrackThatHasNotEndedGoesOn) {
  const config::TrackerConfig config;
  Drive drive(GetParam(), config);
  const TrackId old = drive.at(at_ms(kLast))->id;
  const double coasting = drive.at(at_ms(kLast + 960))->covariance.trace();
  const std::int64_t again = kLast + 960;
  drive.strategy->accept(list_of(1, 100, at_ms(again), {Drive::car(again)}).view());
  drive.strategy->fuse(at_ms(again + 100));
  const auto view = drive.at(at_ms(again));
  ASSERT_TRUE(view);
  EXPECT_EQ(view->id, old);
  EXPECT_FALSE(view->coasting);
  EXPECT_LT(view->covariance.trace(), coasting);
}

// The sensor that sees the car dies. The other goes on without seeing it. The track coasts with that sensor's
// third list and ends with its eighth.
TEST_P(Coasting, ListsThatDoNotSeeItEndATrackSooner) {
  const config::TrackerConfig config;
  Drive drive(GetParam(), config);
  double trace = drive.at(at_ms(kLast))->covariance.trace();
  for (std::uint32_t k = 1; k <= 8; ++k) {
    const std::int64_t ms = kLast + 30 * k;
    drive.strategy->accept(list_of(0, k, at_ms(ms), {position(60.0, -9.0, 0.2)}).view());
    drive.strategy->fuse(at_ms(ms + 100));
    drive.strategy->image(at_ms(ms), drive.shown);
    const auto car =
        std::find_if(drive.shown.begin(), drive.shown.end(), [](const TrackView& view) { return view.state(1) > 0.0; });
    ASSERT_EQ(car != drive.shown.end(), k < 8) << k;
    if (car == drive.shown.end()) continue;
    EXPECT_EQ(car->coasting, k >= 3) << k;
    EXPECT_GT(car->covariance.trace(), trace) << k;
    trace = car->covariance.trace();
  }
}

// Tentative tracks end by the same rule.
TEST(CoastingTracker, ATentativeTrackDoesNotSurviveSilence) {
  const config::TrackerConfig config;
  Tracker tracker(config, 4);
  TrackSet set(tracker.max_tracks());
  tracker.step(set, list_of(0, 0, at_ms(0), {position(20.0, 0.0, 0.2)}).view());
  ASSERT_EQ(set.tracks.size(), 1u);
  const ObservationId birth = set.tracks[0].birth;
  tracker.step(set, list_of(0, 1, at_ms(1'001), {position(20.0, 0.0, 0.2)}).view());
  ASSERT_EQ(set.tracks.size(), 1u);
  EXPECT_FALSE(set.tracks[0].birth == birth);
  EXPECT_EQ(set.tracks[0].lists, 1);
}

}  // namespace
}  // namespace ttf::fusion::tracks
