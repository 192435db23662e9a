// Ids of confirmed tracks never change, however far late lists rewrite the past.
#include "fusion/tracks/identities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

std::map<TrackId, ObservationId> births(const TrackSet& set) {
  std::map<TrackId, ObservationId> named;
  for (const Track& track : set.tracks) {
    EXPECT_TRUE(!track.confirmed || track.id != kNoTrack) << "confirmed without a name";
    if (track.id == kNoTrack) continue;
    const bool fresh = named.try_emplace(track.id, track.birth).second;
    EXPECT_TRUE(fresh) << "two of one name";
  }
  return named;
}

TEST(Identities, AreGivenAtConfirmationAndCountUp) {
  Timeline timeline({}, 16);
  const Lanes lanes{.objects = 3};
  for (std::uint32_t k = 0; k < 6; ++k) {
    timeline.insert(list_of(0, k, at_ms(40 * k), lanes.see(at_ms(40 * k), k)).view());
    const auto named = births(timeline.current());
    ASSERT_EQ(named.size(), k < 2 ? 0u : 3u);
    std::uint16_t id = 0;
    for (const auto& [name, birth] : named) EXPECT_EQ(index_of(name), id++);
  }
}

// Sensor 1 is always three lists late, and sees lanes that sensor 0 does not. It causes late births before
// the others'.
//
//   sensor 0   x0    x40    x80    x120   x160 ...        5 objects
//   sensor 1     x20 ------------------> 145  ...         10 objects, the 5 among them
TEST(Identities, ATrackKeepsItsIdThroughManyLateLists) {
  const Lanes few{.objects = 5, .miss_probability = 0.1, .seed = 3},
      many{.objects = 10, .miss_probability = 0.1, .seed = 4};
  Timeline timeline({}, 16), in_order({}, 16);
  std::map<TrackId, int> object_of;
  std::map<int, std::set<TrackId>> ids_of;
  int late = 0;
  for (std::uint32_t k = 0; k < 200; ++k) {
    const GlobalTime t = at_ms(40 * k);
    timeline.insert(list_of(0, k, t, few.see(t, k)).view());
    in_order.insert(list_of(0, k, t, few.see(t, k)).view());
    const GlobalTime between = at_ms(40 * k + 20);
    in_order.insert(list_of(1, k, between, many.see(between, k)).view());
    if (k >= 3) {
      const GlobalTime past = at_ms(40 * (k - 3) + 20);
      late += timeline.insert(list_of(1, k - 3, past, many.see(past, k - 3)).view()) == Timeline::Insertion::kLate;
    }
    births(timeline.current());
    for (const Track& track : timeline.current().tracks) {
      if (!track.confirmed) continue;
      int nearest = -1;
      for (int object = 0; object < 10; ++object)
        if ((many.truth(object, t) - state_of(track)).head<2>().norm() < 2.0) nearest = object;
      ASSERT_GE(nearest, 0) << "list " << k;
      const auto [known, first] = object_of.try_emplace(track.id, nearest);
      ASSERT_EQ(known->second, nearest) << "id " << index_of(track.id) << " went to another object at list " << k;
      ids_of[nearest].insert(track.id);
    }
  }
  EXPECT_EQ(late, 197);
  ASSERT_EQ(ids_of.size(), 10u);
  for (const auto& [object, ids] : ids_of) EXPECT_EQ(ids.size(), 1u) << "object " << object << " changed its id";
  // Lists still under way in the ordered run are late here; after them, both have taken in the same lists.
  for (std::uint32_t k = 197; k < 200; ++k) {
    const GlobalTime past = at_ms(40 * k + 20);
    timeline.insert(list_of(1, k, past, many.see(past, k)).view());
  }
  EXPECT_TRUE(same_bits(timeline.current(), in_order.current()));
  EXPECT_EQ(births(timeline.current()).size(), births(in_order.current()).size());
}

// The same object, seen earlier by another sensor whose list comes after the track's confirmation.
//
//   sensor 0         x40   x80   x120
//   sensor 1   x20 ------------------> 130
TEST(Identities, ALateListMayMoveTheBirthButNotTheId) {
  Timeline timeline({}, 4);
  const auto car = [](std::int64_t ms) {
    return std::vector{position(20.0 + 0.005 * static_cast<double>(ms), 0.0, 0.2)};
  };
  for (std::uint32_t k = 1; k <= 3; ++k) timeline.insert(list_of(0, k, at_ms(40 * k), car(40 * k)).view());
  ASSERT_EQ(timeline.current().tracks.size(), 1u);
  const TrackId id = timeline.current().tracks[0].id;
  ASSERT_NE(id, kNoTrack);
  EXPECT_EQ(timeline.insert(list_of(1, 0, at_ms(20), car(20)).view()), Timeline::Insertion::kLate);
  ASSERT_EQ(timeline.current().tracks.size(), 1u);
  const Track& moved = timeline.current().tracks[0];
  EXPECT_EQ(moved.birth.measurement.sensor, SensorId{1});
  EXPECT_TRUE(moved.confirmed);
  EXPECT_EQ(moved.id, id);
}

// A track that ended lives on when a late list shows a later sighting.
TEST(Identities, WhoComesBackToLifeHasItsOldName) {
  config::TrackerConfig config;
  config.delete_misses = 3;
  Timeline timeline(config, 4);
  const std::vector<sensors::Observation> car{position(20.0, 0.0, 0.2)}, other{position(40.0, 9.0, 0.2)};
  for (std::uint32_t k = 0; k < 3; ++k) timeline.insert(list_of(0, k, at_ms(40 * k), car).view());
  const TrackId id = timeline.current().tracks[0].id;
  for (std::uint32_t k = 3; k < 6; ++k) timeline.insert(list_of(0, k, at_ms(40 * k), other).view());
  ASSERT_EQ(timeline.current().tracks.size(), 1u);
  const TrackId second = timeline.current().tracks[0].id;
  EXPECT_NE(second, id);
  timeline.insert(list_of(1, 0, at_ms(170), car).view());
  ASSERT_EQ(timeline.current().tracks.size(), 2u);
  EXPECT_EQ(timeline.current().tracks[0].id, id);
  EXPECT_EQ(timeline.current().tracks[1].id, second);
}

// Thousands of tracks come and go: names are never reused, and storage does not grow.
TEST(Identities, AreNotGivenAgain) {
  config::TrackerConfig config;
  config.delete_misses = 2;
  config.history_scans = 4;
  Timeline timeline(config, 4);
  std::set<TrackId> seen;
  std::uint32_t sequence = 0;
  for (int episode = 0; episode < 2000; ++episode) {
    for (int k = 0; k < 3; ++k, ++sequence)
      timeline.insert(
          list_of(0, sequence, at_ms(40 * sequence), {position(20.0 + 40.0 * (episode % 2), 0.0, 0.2)}).view());
    bool fresh = false;
    for (const Track& track : timeline.current().tracks)
      if (track.misses == 0) fresh = seen.insert(track.id).second;
    ASSERT_TRUE(fresh) << "episode " << episode;
  }
  EXPECT_EQ(seen.size(), 2000u);
}

}  // namespace
}  // namespace ttf::fusion::tracks
