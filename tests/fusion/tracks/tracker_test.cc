// Birth, confirmation, deletion, and a track's fields in an image.
#include "fusion/tracks/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "fusion/association/assignment.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/motion/angles.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

int confirmed(const TrackSet& set) {
  return static_cast<int>(
      std::count_if(set.tracks.begin(), set.tracks.end(), [](const Track& t) { return t.confirmed; }));
}

struct Bench {
  config::TrackerConfig config;
  Tracker tracker;
  TrackSet set;
  std::uint32_t sequence = 0;

  explicit Bench(config::TrackerConfig c = {}) : config(c), tracker(c, 64), set(tracker.max_tracks()) {}
  void step(std::int64_t ms, std::vector<sensors::Observation> observations) {
    tracker.step(set, list_of(0, sequence++, at_ms(ms), std::move(observations)).view());
  }
};

// Every pattern of hits and misses over ten lists, against the rule in words. A hit without a track starts a
// track. Three hits in its last five lists confirm it. A tentative track ends once 3 of 5 are out of reach. A
// confirmed track ends with the 4th miss in a row.
TEST(Tracker, EveryPatternOfHitsFollowsTheRule) {
  config::TrackerConfig config;
  config.confirm_hits = 3;
  config.confirm_window = 5;
  config.delete_misses = 4;
  config.process_noise = 0.01;
  config.initial_velocity_sigma = 0.1;
  for (unsigned pattern = 0; pattern < 1u << 10; ++pattern) {
    Bench bench(config);
    std::optional<std::string> history;  // the living track's
    bool is_confirmed = false;
    unsigned born = 0;
    for (int k = 0; k < 10; ++k) {
      const bool hit = pattern >> k & 1u;
      bench.step(50 * k, hit ? std::vector{position(20.0, 3.0, 0.1)} : std::vector<sensors::Observation>{});
      if (!history && hit) {
        history = "";
        is_confirmed = false;
        born = static_cast<unsigned>(k);
      }
      if (history) {
        *history += hit ? 'h' : '-';
        const std::string recent = history->substr(history->size() > 5 ? history->size() - 5 : 0);
        const auto hits = std::count(recent.begin(), recent.end(), 'h');
        is_confirmed = is_confirmed || hits >= 3;
        const auto still_to_come = static_cast<std::ptrdiff_t>(5 - recent.size());
        const bool ends = is_confirmed ? history->size() >= 4 && history->substr(history->size() - 4) == "----"
                                       : hits + still_to_come < 3;
        if (ends) history.reset();
      }
      ASSERT_EQ(bench.set.tracks.size(), history ? 1u : 0u) << "pattern " << pattern << " list " << k;
      if (history) {
        ASSERT_EQ(bench.set.tracks[0].confirmed, is_confirmed) << "pattern " << pattern << " list " << k;
        ASSERT_EQ(bench.set.tracks[0].birth.measurement.sequence, born);
      }
    }
  }
}

TEST(Tracker, TooUncertainAPositionEndsATrack) {
  config::TrackerConfig config;
  config.delete_misses = 1000;
  config.delete_after = Duration::milliseconds(100'000);
  config.delete_position_sigma = 2.0;
  Bench bench(config);
  for (int k = 0; k < 6; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.1)});
  ASSERT_EQ(confirmed(bench.set), 1);
  std::int64_t ms = 250;
  while (!bench.set.tracks.empty() && ms < 10'000) bench.step(ms += 50, {});
  // With q = 3, sqrt(q t^3 / 3) alone reaches 2 m after 1.6 s.
  EXPECT_GT(ms, 500);
  EXPECT_LT(ms, 250 + 1600 + 50);
}

TEST(Tracker, NoMoreConfirmedTracksThanTheImageHolds) {
  Bench bench;
  Lanes lanes{.objects = 30};
  for (int k = 0; k < 12; ++k) bench.step(40 * k, lanes.see(at_ms(40 * k), static_cast<std::uint32_t>(k)));
  EXPECT_EQ(confirmed(bench.set), 25);
  EXPECT_EQ(bench.set.tracks.size(), 30u);
}

TEST(Tracker, Follows25ObjectsEachWithItsOwnTrack) {
  Bench bench;
  Lanes lanes{.miss_probability = 0.1};
  std::vector<std::optional<ObservationId>> track_of(25);
  double squares = 0.0;
  int count = 0;
  for (int k = 0; k < 100; ++k) {
    const GlobalTime t = at_ms(40 * k);
    bench.step(40 * k, lanes.see(t, static_cast<std::uint32_t>(k)));
    if (k < 15) continue;
    ASSERT_EQ(confirmed(bench.set), 25) << "list " << k;
    for (int object = 0; object < 25; ++object) {
      const estimators::State truth = lanes.truth(object, t);
      const auto nearest =
          std::min_element(bench.set.tracks.begin(), bench.set.tracks.end(), [&](const Track& a, const Track& b) {
            return (state_of(a) - truth).head<2>().squaredNorm() < (state_of(b) - truth).head<2>().squaredNorm();
          });
      const double squared = (state_of(*nearest) - truth).head<2>().squaredNorm();
      ASSERT_LT(squared, 1.0);
      squares += squared;
      ++count;
      std::optional<ObservationId>& birth = track_of[static_cast<std::size_t>(object)];
      if (!birth) birth = nearest->birth;
      ASSERT_TRUE(birth == nearest->birth) << "object " << object << " changed its track";
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.2) << "better than one measurement's 0.28 m in the plane";
}

// The observation of each track when every pair is tried: the plain way.
std::vector<int> tried_pair_by_pair(const Tracker& tracker, const TrackSet& set, const sensors::ObservationList& list,
                                    double gate) {
  std::vector<association::Candidate> candidates;
  for (std::size_t o = 0; o < list.observations.size(); ++o)
    for (std::size_t t = 0; t < set.tracks.size(); ++t) {
      const auto apart = tracker.estimator().distance_squared(set.tracks[t].estimate, list.observations[o]);
      if (apart && *apart <= gate)
        candidates.push_back(
            {static_cast<int>(o), static_cast<int>(t), gate - *apart + 1e-9 + (set.tracks[t].confirmed ? 100.0 : 0.0)});
    }
  association::Assignment assignment(list.observations.size(), set.tracks.size());
  assignment.solve(candidates, list.observations.size(), set.tracks.size());
  std::vector<int> observation_of(set.tracks.size(), -1);
  for (std::size_t o = 0; o < list.observations.size(); ++o)
    if (const int t = assignment.column_of()[o]; t >= 0)
      observation_of[static_cast<std::size_t>(t)] = static_cast<int>(o);
  return observation_of;
}

// Crowds on lanes or in a heap, with misses and clutter. Large ones are searched in strips.
TEST(Tracker, AssignsAsThePlainWayDoes) {
  int assigned = 0;
  for (const int objects : {10, 60, 65, 150, 300}) {
    config::TrackerConfig config;
    config.max_objects = objects;
    const double gate = metrics::chi_square_quantile(config.gate_probability, 2);
    Tracker tracker(config, static_cast<std::size_t>(2 * objects));
    TrackSet set(tracker.max_tracks()), now(tracker.max_tracks());
    const Lanes lanes{.objects = objects, .across = 10, .sigma = 0.3, .miss_probability = 0.2, .seed = 5};
    RandomStream draw({.seed = 6, .purpose = Purpose::kTest, .entity = 13});
    for (std::uint32_t k = 0; k < 12; ++k) {
      std::vector<sensors::Observation> seen = lanes.see(at_ms(40 * k), k);
      for (sensors::Observation& z : seen)
        if (objects == 150) z.z(0) = 20.0 + 0.05 * (z.z(0) - 20.0);  // a heap
      for (int i = 0; i < objects / 2; ++i)
        seen.push_back(position(draw.uniform(0.0, 400.0), draw.uniform(-80.0, 80.0), draw.uniform(0.1, 3.0)));
      const OwnedList list = list_of(0, k, at_ms(40 * k), seen);
      now = set;
      now.tracks.reserve(tracker.max_tracks());
      for (Track& track : now.tracks) tracker.estimator().predict(track.estimate, 0.04);
      const auto expected = tried_pair_by_pair(tracker, now, list.view(), gate);
      const auto found = tracker.assigned(now, list.view());
      ASSERT_EQ(std::vector(found.begin(), found.end()), expected) << objects << " objects, list " << k;
      assigned += static_cast<int>(std::count_if(expected.begin(), expected.end(), [](int o) { return o >= 0; }));
      tracker.step(set, list.view());
    }
  }
  EXPECT_GT(assigned, 3'000);
}

TEST(Tracker, TheSecondEchoOfAConfirmedTrackIsNoNewObject) {
  Bench bench;
  for (int k = 0; k < 6; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.3)});
  ASSERT_EQ(confirmed(bench.set), 1);
  bench.step(300, {position(20.05, 0.0, 0.3), position(19.8, 0.1, 0.3), position(40.0, 5.0, 0.3)});
  ASSERT_EQ(bench.set.tracks.size(), 2u);
  EXPECT_NEAR(state_of(bench.set.tracks[1])(0), 40.0, 1e-12);
}

TEST(Tracker, GatesOutWhatIsTooFar) {
  Bench bench;
  for (int k = 0; k < 20; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.1)});
  bench.step(1000, {position(21.5, 0.0, 0.1)});
  ASSERT_EQ(bench.set.tracks.size(), 2u);
  EXPECT_EQ(bench.set.tracks[0].misses, 1);
  EXPECT_NEAR(state_of(bench.set.tracks[0])(0), 20.0, 0.1);
}

TEST(Tracker, AConfirmedTrackKeepsItsObservationFromATentativeOne) {
  // The tentative track lies nearer, but the confirmed track gets an observation that both want.
  Bench bench;
  for (int k = 0; k < 6; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.3)});
  bench.step(300, {position(20.0, 0.0, 0.3), position(22.0, 0.0, 0.3)});
  ASSERT_EQ(bench.set.tracks.size(), 2u);
  bench.step(350, {position(20.8, 0.0, 0.3)});
  EXPECT_EQ(bench.set.tracks[0].misses, 0);
  EXPECT_EQ(bench.set.tracks[1].misses, 1);
}

TEST(Tracker, HeadingIsMeasuredUpToHalfATurnAndAveraged) {
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
  EXPECT_FALSE(track.extent.knows_length()) << "hardly better than by the prior";
  EXPECT_FALSE(track.extent.knows_width());
}

// The first two positions show a car that backs, which is noise. Its axis is taken at the other end.
//
//   0 s          10 s            20 s
//   creeps with 0.5 m/s, stands
TEST(Tracker, ACarThatCreptAndStandsFacesItsFront) {
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

Track moving_track(double vx, double vy, double sigma_v) {
  Track track;
  const double v = sigma_v * sigma_v;
  track.estimate =
      linear::Gaussian<4>{linear::Vector<4>(10.0, 2.0, vx, vy), linear::Vector<4>(0.1, 0.1, v, v).asDiagonal()};
  return track;
}

TEST(View, CourseTellsTheHeadingOfWhatMoves) {
  const Track track = moving_track(-3.0, 4.0, 0.5);
  const TrackView view = shown(track, at_ms(0), at_ms(0));
  EXPECT_NEAR(view.heading, std::atan2(4.0, -3.0), 1e-12);
  EXPECT_NEAR(view.sigma_heading, 0.5 / 5.0, 1e-12);
  EXPECT_NEAR(view.speed, 5.0, 1e-12);
  EXPECT_NEAR(view.sigma_speed, 0.5, 1e-12);
}

TEST(View, AxisTellsTheHeadingOfWhatStandsAndCourseTellsItsFront) {
  Track standing = moving_track(0.01, 0.0, 0.5);
  standing.heading = {{2.0, 0.01, true}};
  EXPECT_NEAR(shown(standing, at_ms(0), at_ms(0)).heading, 2.0, 1e-12);
  // Driving along +x with an axis measured half a turn off: turned towards the direction of travel.
  Track driving = moving_track(10.0, 0.0, 1.0);
  driving.heading = {{std::numbers::pi - 0.2, 0.01, true}};  // course variance is 0.01 too
  const TrackView view = shown(driving, at_ms(0), at_ms(0));
  EXPECT_NEAR(view.heading, -0.1, 1e-12);
  EXPECT_NEAR(view.sigma_heading, std::sqrt(0.005), 1e-12);
  Track unknown = moving_track(0.0, 0.0, 0.5);
  EXPECT_NEAR(shown(unknown, at_ms(0), at_ms(0)).sigma_heading, std::numbers::pi / std::sqrt(3.0), 1e-12);
}

TEST(View, SigmaContainsTheDoubtWhichEndIsTheFront) {
  constexpr double kPi = std::numbers::pi;
  Track track = moving_track(0.0, 0.0, 0.5);
  track.heading = {{0.2, 0.01, true}};
  EXPECT_NEAR(shown(track, at_ms(0), at_ms(0)).sigma_heading, std::sqrt(0.01 + 0.5 * kPi * kPi), 1e-12);
  // A course of two standard deviations is wrong once in 44 times, by the normal distribution's table.
  track = moving_track(-1.0, 0.0, 0.5);
  track.heading = {{0.0, 0.01, true}};
  const TrackView backwards = shown(track, at_ms(0), at_ms(0));
  EXPECT_NEAR(std::abs(backwards.heading), kPi, 1e-12);
  EXPECT_NEAR(backwards.sigma_heading, std::sqrt(0.25 * 0.01 / 0.26 + 0.02275 * kPi * kPi), 1e-4);
  // Against what is remembered, it is noise.
  track.heading.front = 1;
  const TrackView remembered = shown(track, at_ms(0), at_ms(0));
  EXPECT_NEAR(remembered.heading, 0.0, 1e-12);
  EXPECT_NEAR(remembered.sigma_heading, 0.1, 1e-12);
}

TEST(View, AccelerationIsAlongTheHeading) {
  config::TrackerConfig config;
  config.motion = config::MotionModel::kConstantAcceleration;
  Track track = moving_track(0.0, 10.0, 0.1);
  linear::Gaussian<6> accelerating = seen_as(track.estimate);
  accelerating.x.tail<2>() << 5.0, -2.0;
  accelerating.p(4, 4) = 9.0;
  accelerating.p(5, 5) = 0.25;
  track.estimate = accelerating;
  const TrackView view = shown(track, at_ms(0), at_ms(0), config);
  EXPECT_NEAR(view.acceleration, -2.0, 1e-12) << "braking; what points sideways does not count";
  EXPECT_NEAR(view.sigma_acceleration, 0.5, 1e-9);
}

TEST(View, IsPredictedButNeverBackwards) {
  const config::TrackerConfig config;
  Track track = moving_track(2.0, -1.0, 0.5);
  track.extent.size(0) = 4.0;
  track.extent.covariance(0, 0) = 0.04;
  const TrackView later = shown(track, at_ms(1000), at_ms(1500), config);
  EXPECT_NEAR(later.state(0), 11.0, 1e-12);
  EXPECT_NEAR(later.state(1), 1.5, 1e-12);
  EXPECT_NEAR(later.covariance(0, 0), 0.1 + 0.25 * 0.25 + 3.0 * 0.125 / 3.0, 1e-12);
  EXPECT_NEAR(later.sigma_length, 0.2, 1e-12);
  EXPECT_EQ(later.valid_at, at_ms(1500));
  const TrackView earlier = shown(track, at_ms(1000), at_ms(900), config);
  EXPECT_EQ(earlier.state, state_of(track));
  EXPECT_EQ(earlier.valid_at, at_ms(1000)) << "the instant its state is of";
}

}  // namespace
}  // namespace ttf::fusion::tracks
