// However lists arrive, the tracks are bit for bit those of arrival in order.
#include "fusion/tracks/timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

// In chronological order, with three lists of one instant: by sensor, then by sequence.
//
//   sensor 0   a0         a1,a2                a3
//   sensor 1              b0        b1
//             0 ms       40 ms     80 ms     120 ms
std::vector<OwnedList> six_lists() {
  const Lanes first{.objects = 6, .seed = 1}, second{.objects = 6, .miss_probability = 0.2, .seed = 2};
  return {list_of(0, 0, at_ms(0), first.see(at_ms(0), 0)),    list_of(0, 1, at_ms(40), first.see(at_ms(40), 1)),
          list_of(0, 2, at_ms(40), first.see(at_ms(40), 2)),  list_of(1, 0, at_ms(40), second.see(at_ms(40), 0)),
          list_of(1, 1, at_ms(80), second.see(at_ms(80), 1)), list_of(0, 3, at_ms(120), first.see(at_ms(120), 3))};
}

TEST(Timeline, EveryOrderOfSixListsGivesTheSameBits) {
  const std::vector<OwnedList> lists = six_lists();
  config::TrackerConfig config;
  Timeline in_order(config, 16);
  for (const OwnedList& s : lists) ASSERT_EQ(in_order.insert(s.view()), Timeline::Insertion::kInOrder);
  ASSERT_GE(in_order.current().tracks.size(), 6u);

  std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
  int permutations = 0;
  do {
    Timeline timeline(config, 16);
    std::size_t latest = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool late = i > 0 && order[i] < latest;
      latest = std::max(latest, order[i]);
      ASSERT_EQ(timeline.insert(lists[order[i]].view()),
                late ? Timeline::Insertion::kLate : Timeline::Insertion::kInOrder);
    }
    ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << "permutation " << permutations;
    ++permutations;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(permutations, 720);

  // The comparison can fail: without one of them the tracks are others.
  for (std::size_t left_out = 0; left_out < lists.size(); ++left_out) {
    Timeline timeline(config, 16);
    for (std::size_t i = 0; i < lists.size(); ++i)
      if (i != left_out) timeline.insert(lists[i].view());
    EXPECT_FALSE(same_bits(timeline.current(), in_order.current())) << "list " << left_out;
  }
}

// A list has the innovations of its own place, whenever it comes. Six objects are confirmed after three lists. From then on
// their squares add up to the sum over lists in order.
TEST(Timeline, ALateListHasTheInnovationsOfItsPlace) {
  const Lanes lanes{.objects = 6, .seed = 4};
  const auto list = [&](int k) {
    return list_of(0, static_cast<std::uint32_t>(k), at_ms(40 * k),
                   lanes.see(at_ms(40 * k), static_cast<std::uint32_t>(k)));
  };
  config::TrackerConfig config;
  Timeline in_order(config, 16), late(config, 16);
  for (int k = 0; k < 3; ++k) {
    in_order.insert(list(k).view());
    EXPECT_EQ(in_order.innovations().degrees, 0u) << "tracks without a confirmation, list " << k;
    late.insert(list(k).view());
  }
  in_order.insert(list(3).view());
  const Innovations expected = in_order.innovations();
  EXPECT_EQ(expected.degrees, 12u);
  // By hand: each track's own distance to the nearest observation.
  Timeline before(config, 16);
  for (int k = 0; k < 3; ++k) before.insert(list(k).view());
  double squares = 0.0;
  for (const Track& track : before.current().tracks) {
    estimators::Estimate estimate = track.estimate;
    before.estimator().predict(estimate, 0.04);
    double nearest = 1e9;
    for (const sensors::Observation& z : list(3).observations)
      nearest = std::min(nearest, before.estimator().distance_squared(estimate, z).value_or(1e9));
    squares += nearest;
  }
  EXPECT_NEAR(expected.squares, squares, 1e-9);
  late.insert(list(4).view());
  late.insert(list(3).view());
  EXPECT_EQ(late.innovations().squares, expected.squares);
  EXPECT_EQ(late.innovations().degrees, expected.degrees);
}

// An object seen 18.5 m further after 2 s is taken for another one. A late list from between shows its speed
// and reopens the association.
//
//   x [m]                             o 18.5
//                    o 7.5 (late)
//        o 0
//       0 s         1 s              2 s
TEST(Timeline, ALateListReopensAssociations) {
  config::TrackerConfig config;
  config.initial_velocity_sigma = 2.0;
  config.process_noise = 4.0;
  config.delete_position_sigma = 50.0;
  config.delete_after = Duration::milliseconds(2'000);
  Timeline timeline(config, 4);
  timeline.insert(list_of(0, 0, at_ms(0), {position(0.0, 0.0, 0.1)}).view());
  timeline.insert(list_of(0, 1, at_ms(2000), {position(18.5, 0.0, 0.1)}).view());
  EXPECT_EQ(timeline.current().tracks.size(), 2u);
  timeline.insert(list_of(1, 0, at_ms(1000), {position(7.5, 0.0, 0.1)}).view());
  ASSERT_EQ(timeline.current().tracks.size(), 1u);
  EXPECT_EQ(timeline.current().tracks[0].hits, 0b111u);
  EXPECT_NEAR(state_of(timeline.current().tracks[0])(0), 18.5, 0.2);
}

// Four lists of history, ten in order at 0, 40 .. 360 ms:
//
//   0 . . . 160  [200]  240 280 320 360        [ ] the newest that cannot be gone back behind
//               ^     ^
//            199 no  201 yes
TEST(Timeline, HistoryHasAnEnd) {
  config::TrackerConfig config;
  config.history_scans = 4;
  const Lanes lanes{.objects = 3};
  const auto lanes_scan = [&](std::uint8_t sensor, std::uint32_t sequence, std::int64_t ms) {
    return list_of(sensor, sequence, at_ms(ms), lanes.see(at_ms(ms), sequence));
  };
  Timeline timeline(config, 8), in_order(config, 8);
  for (std::uint32_t k = 0; k < 10; ++k) {
    timeline.insert(lanes_scan(0, k, 40 * k).view());
    if (k == 6) in_order.insert(lanes_scan(1, 100, 201).view());
    in_order.insert(lanes_scan(0, k, 40 * k).view());
  }
  const TrackSet before_too_old = timeline.current();
  EXPECT_EQ(timeline.insert(lanes_scan(1, 99, 199).view()), Timeline::Insertion::kTooOld);
  EXPECT_TRUE(same_bits(timeline.current(), before_too_old));
  EXPECT_FALSE(timeline.contains({static_cast<SensorId>(1), 99}, at_ms(199)));
  EXPECT_EQ(timeline.insert(lanes_scan(1, 100, 201).view()), Timeline::Insertion::kLate);
  EXPECT_TRUE(same_bits(timeline.current(), in_order.current()));
  EXPECT_TRUE(timeline.contains({static_cast<SensorId>(1), 100}, at_ms(201)));
}

TEST(Timeline, LongDrivesInDisorder) {
  // 200 lists of two sensors, each up to 12 places late; objects appear and get lost.
  config::TrackerConfig config;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RandomStream stream({.seed = seed});
    const Lanes lanes{.objects = 10, .miss_probability = 0.4, .seed = seed};
    std::vector<OwnedList> lists;
    for (std::uint32_t k = 0; k < 200; ++k)
      lists.push_back(list_of(static_cast<std::uint8_t>(k % 2), k, at_ms(21 * k), lanes.see(at_ms(21 * k), k)));
    std::vector<std::pair<double, std::size_t>> arrival;
    for (std::size_t k = 0; k < lists.size(); ++k)
      arrival.push_back({static_cast<double>(k) + stream.uniform(0.0, 12.0), k});
    std::sort(arrival.begin(), arrival.end());
    Timeline in_order(config, 16), timeline(config, 16);
    int late = 0;
    for (const OwnedList& s : lists) in_order.insert(s.view());
    for (const auto& [when, k] : arrival) late += timeline.insert(lists[k].view()) == Timeline::Insertion::kLate;
    EXPECT_GT(late, 50);
    EXPECT_TRUE(same_bits(timeline.current(), in_order.current())) << "seed " << seed;
  }
}

// Lists keep their tracks at intervals while nothing is late, and more of them once something was. Each list of a calm drive
// is held back in its turn, by every distance that the history reaches, and another one later.
TEST(Timeline, EveryDistanceAfterACalm) {
  config::TrackerConfig config;
  config.history_scans = 24;
  constexpr std::uint32_t kLists = 100;
  const Lanes lanes{.objects = 4, .miss_probability = 0.3, .seed = 6};
  std::vector<OwnedList> lists;
  Timeline in_order(config, 8);
  for (std::uint32_t k = 0; k < kLists; ++k) {
    lists.push_back(list_of(static_cast<std::uint8_t>(k % 2), k, at_ms(21 * k), lanes.see(at_ms(21 * k), k)));
    in_order.insert(lists.back().view());
  }
  for (std::uint32_t distance = 1; distance <= 24; ++distance)
    for (std::uint32_t held = 40; held < 50; ++held) {
      Timeline timeline(config, 8);
      const std::uint32_t second = 74, nearer = distance / 2 + 1;
      const auto expect = [&](std::uint32_t k, Timeline::Insertion insertion) {
        ASSERT_EQ(timeline.insert(lists[k].view()), insertion) << k;
      };
      for (std::uint32_t k = 0; k < kLists; ++k) {
        if (k != held && k != second) expect(k, Timeline::Insertion::kInOrder);
        if (k == held + distance) expect(held, Timeline::Insertion::kLate);
        if (k == second + nearer) expect(second, Timeline::Insertion::kLate);
      }
      ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << distance << " behind, list " << held;
    }
}

// Late lists open associations again where it matters most: two objects that cross, and clutter.
TEST(Timeline, CrossingObjectsInClutterShuffled) {
  RandomStream stream({.seed = 2});
  std::vector<OwnedList> lists;
  for (std::uint32_t k = 0; k < 40; ++k) {
    const double t = 0.05 * k;
    std::vector<sensors::Observation> list{
        position(20 + 6 * t + 0.3 * stream.normal(), -3 + 3 * t + 0.3 * stream.normal(), 0.3),
        position(32 - 6 * t + 0.3 * stream.normal(), 3 - 3 * t + 0.3 * stream.normal(), 0.3)};
    if (stream.uniform() < 0.4) list.push_back(position(stream.uniform(10, 40), stream.uniform(-8, 8), 0.2));
    lists.push_back(list_of(static_cast<std::uint8_t>(k % 3), k / 3, at_ms(50 * k), std::move(list)));
  }
  Timeline in_order({}, 16);
  for (const OwnedList& s : lists) in_order.insert(s.view());
  for (int shuffle = 0; shuffle < 100; ++shuffle) {
    std::vector<std::size_t> order(lists.size());
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size(); i-- > 1;)
      std::swap(order[i], order[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i)))]);
    Timeline timeline({}, 16);
    for (const std::size_t s : order) timeline.insert(lists[s].view());
    ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << "shuffle " << shuffle;
  }
}

}  // namespace
}  // namespace ttf::fusion::tracks
