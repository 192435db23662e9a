// Lost lists and silent sensors. The result is that of the arrived lists in order. No list waits longer than
// the schedule says.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/drives.h"

namespace ttf::fusion::tracks {
namespace {

class LostLists : public testing::TestWithParam<strategies::StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, LostLists, testing::ValuesIn(strategies::kAllStrategies), name_of_strategy);

// A span of the drive in which a sensor is dead. Its last list may still be on its way.
struct Silence {
  SensorId sensor;
  std::int64_t from_ms, to_ms;
};

// The rest of a drawn drive: without one list in `one_in`, and without all that were measured in a silence.
std::vector<Arrival> survivors(std::uint64_t seed, std::int64_t one_in, const std::vector<Silence>& silences) {
  RandomStream stream({.seed = seed, .entity = 1});
  std::vector<Arrival> left;
  for (Arrival& arrival : drawn_drive(seed, 50)) {
    const bool silent = std::any_of(silences.begin(), silences.end(), [&](const Silence& s) {
      return s.sensor == arrival.list.id.sensor && arrival.list.measured >= at_ms(s.from_ms) &&
             arrival.list.measured < at_ms(s.to_ms);
    });
    if (stream.integer(1, one_in) != 1 && !silent) left.push_back(std::move(arrival));
  }
  return left;
}

// The image at `at` by an oracle without lost lists. Names are each strategy's own.
std::vector<TrackView> in_order(std::vector<Arrival> arrivals, GlobalTime at) {
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    return before(a.list.id, a.list.measured, b.list.id, b.list.measured);
  });
  Timeline timeline(config::TrackerConfig{}, config::TrackerConfig{}.max_observations);
  for (const Arrival& arrival : arrivals) timeline.insert(arrival.list.view());
  const TrackSet& set = timeline.current();
  std::vector<TrackView> views;
  for (const Track& track : set.tracks)
    if (track.confirmed && !given_up(track, set.time, at, {}, timeline.estimator()))
      views.push_back(view_of(track, set.time, at, {}, timeline.estimator()));
  return views;
}

void expect_as_if_never_sent(strategies::StrategyKind kind, const std::vector<Arrival>& arrivals, std::size_t tracks) {
  constexpr std::int64_t kEnd = 4'200, kLongestWay = 60;  // [ms]
  const auto strategy = make_strategy(kind, {}, laser_and_camera());
  const std::vector<Fused> result = run(*strategy, arrivals, kEnd);
  std::map<MeasurementId, std::pair<std::int64_t, std::int64_t>> times;  // measured, arrived
  for (const Arrival& a : arrivals) times[a.list.id] = {(a.list.measured - GlobalTime{}).ns / 1'000'000, a.ms};
  EXPECT_EQ(result.size(), arrivals.size()) << "each once";
  for (const Fused& f : result) {
    ASSERT_TRUE(times.contains(f.id)) << "invented";
    const auto [measured, arrived] = times[f.id];
    const bool late = f.disposition == strategies::Disposition::kFusedLate;
    ASSERT_TRUE(f.disposition == strategies::Disposition::kFused || (late && kind == strategies::StrategyKind::kAdva))
        << "no list came after its instant was settled: " << f;
    // The first fusion instant, every 10 ms, after which no older list can arrive.
    ASSERT_LT(f.ms,
              (kind == strategies::StrategyKind::kAdva ? arrived : std::max(arrived, measured + kLongestWay)) + 10)
        << f;
  }
  std::vector<TrackView> shown, expected = in_order(arrivals, at_ms(kEnd));
  strategy->image(at_ms(kEnd), shown);
  for (std::vector<TrackView>* views : {&shown, &expected})
    for (TrackView& view : *views) view.id = {};
  EXPECT_TRUE(same_bits(shown, expected));
  EXPECT_EQ(shown.size(), tracks);
}

constexpr SensorId kLaser{0}, kCamera{1};

TEST_P(LostLists, OneInFive) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_as_if_never_sent(GetParam(), survivors(seed, 5, {}), 25);
}

TEST_P(LostLists, OneSensorDeadForGood) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    expect_as_if_never_sent(GetParam(), survivors(seed, 50, {{kLaser, 1'000, 10'000}}), 25);
    expect_as_if_never_sent(GetParam(), survivors(seed, 50, {{kCamera, 1'000, 10'000}}), 25);
  }
}

TEST_P(LostLists, ASensorDeadForAWhileAndThenTheOther) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    expect_as_if_never_sent(GetParam(), survivors(seed, 20, {{kLaser, 500, 1'700}, {kCamera, 2'000, 2'600}}), 25);
}

// Both sensors are silent for longer than any track survives: all later tracks are new.
TEST_P(LostLists, BothDeadForAWhile) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    expect_as_if_never_sent(GetParam(), survivors(seed, 20, {{kLaser, 1'000, 2'400}, {kCamera, 1'000, 2'400}}), 25);
}

TEST_P(LostLists, BothDeadForGood) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    expect_as_if_never_sent(GetParam(), survivors(seed, 20, {{kLaser, 2'000, 10'000}, {kCamera, 2'000, 10'000}}), 0);
}

// A sensor restarts. Its numbers begin again while lists of its first life are still in the history.
//
//   number     0    1    2  ...  9                 0    1    2  ...  9
//   measured   0    80   160     720   (silent)    1000 1080 1160    1720
TEST_P(LostLists, ASensorThatRestartsCountsAnewAndIsNotTakenForItself) {
  const auto strategy = make_strategy(GetParam(), {}, std::vector{free_running(0, 60)});
  // The second life begins with another object first in the list. Its number and place are those of the first
  // one's birth.
  const auto a = [](std::int64_t ms) { return position(20.0 + 0.002 * static_cast<double>(ms), 0.0, 0.1); };
  const auto b = [](std::int64_t ms) { return position(40.0 - 0.003 * static_cast<double>(ms), 8.0, 0.1); };
  std::vector<Arrival> arrivals;
  for (std::uint32_t k = 0; k < 10; ++k) {
    const std::int64_t first = 80 * k, second = 1'000 + 80 * k;
    arrivals.push_back({first + 30, list_of(0, k, at_ms(first), {a(first)})});
    arrivals.push_back({second + 30, list_of(0, k, at_ms(second), {b(second), a(second)})});
  }
  const std::vector<Fused> result = run(*strategy, arrivals, 1'800);
  EXPECT_EQ(result.size(), 20u);
  for (const Fused& f : result) EXPECT_EQ(f.disposition, strategies::Disposition::kFused) << f;
  ASSERT_EQ(strategy->newest().size(), 1u);
  EXPECT_EQ(strategy->newest()[0].sequence, 9u);
  EXPECT_EQ(strategy->newest_measured(), at_ms(1'720));
  std::vector<TrackView> image;
  strategy->image(at_ms(1'800), image);
  ASSERT_EQ(image.size(), 2u);
  EXPECT_NE(image[0].id, image[1].id);
  EXPECT_NEAR(image[0].state(0), 23.6, 0.3) << "the first one lived on";
  EXPECT_NEAR(image[1].state(0), 34.6, 0.3);
}

// A sensor's newest list is the last measured, regardless of its number.
TEST_P(LostLists, TheNewestOfARestartedSensorIsFoundByItsInstant) {
  const auto strategy = make_strategy(GetParam(), {}, std::vector{free_running(0, 60)});
  run(*strategy, {{30, list_of(0, 500, at_ms(0))}, {330, list_of(0, 2, at_ms(300))}}, 400);
  ASSERT_EQ(strategy->newest().size(), 1u);
  EXPECT_EQ(strategy->newest()[0].sequence, 2u);
}

}  // namespace
}  // namespace ttf::fusion::tracks
