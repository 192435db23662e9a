// Ids of confirmed tracks never change, however far late lists rewrite the past.
#include "fusion/tracks/identities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "core/random.h"
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
TEST(Identities, ATrackThatComesBackToLifeHasItsOldName) {
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

// The plain way, one identity after the other: the oracle.
class PlainIdentities {
 public:
  explicit PlainIdentities(std::size_t max_tracks) : most_(2 * max_tracks) {}

  void name(TrackSet& set, GlobalTime oldest) {
    for (Identity& identity : known_) identity.alive = false;
    for (Track& track : set.tracks) {
      track.id = kNoTrack;
      take_first(track, set.time, [&](const Identity& i) { return i.birth == track.birth; });
    }
    for (Track& track : set.tracks)
      if (track.id == kNoTrack)
        take_first(track, set.time, [&](const Identity& i) { return !i.alive && i.newest == track.newest; });
    std::erase_if(known_, [&](const Identity& i) { return !i.alive && i.seen < oldest; });
    for (Track& track : set.tracks) {
      if (track.id != kNoTrack || !track.confirmed) continue;
      if (known_.size() == most_) forget_longest_dead();
      while (static_cast<TrackId>(next_) == kNoTrack ||
             std::any_of(known_.begin(), known_.end(),
                         [&](const Identity& i) { return i.alive && i.id == static_cast<TrackId>(next_); }))
        ++next_;
      known_.push_back({.id = static_cast<TrackId>(next_++)});
      take_first(track, set.time, [&](const Identity& i) { return &i == &known_.back(); });
    }
  }
  std::size_t forgotten = 0;

 private:
  struct Identity {
    TrackId id{};
    ObservationId birth{}, newest{};
    GlobalTime seen{};
    bool alive = false;
  };
  template <class Is> void take_first(Track& track, GlobalTime now, const Is& is) {
    const auto one = std::find_if(known_.begin(), known_.end(), is);
    if (one == known_.end()) return;
    *one = {one->id, track.birth, track.newest, now, true};
    track.id = one->id;
  }
  void forget_longest_dead() {
    const auto longest = std::min_element(known_.begin(), known_.end(), [](const Identity& a, const Identity& b) {
      return a.alive != b.alive ? b.alive : a.seen < b.seen;
    });
    ASSERT_FALSE(longest->alive);
    known_.erase(longest);
    ++forgotten;
  }

  std::size_t most_;
  std::vector<Identity> known_;
  std::uint16_t next_ = 0;
};

// Tracks come, are confirmed or not, are not seen, end, come back, and have their births moved; ids run out.
TEST(Identities, AreThoseOfThePlainWay) {
  std::size_t forgotten = 0, moved = 0, revived = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomStream draw({.seed = seed, .purpose = Purpose::kTest, .entity = 11});
    const auto most = static_cast<std::size_t>(draw.integer(1, 24));
    Identities identities(most);
    PlainIdentities plain(most);
    TrackSet set(most), away(4 * most);
    for (std::uint32_t k = 0; k < 300; ++k) {
      set.time = at_ms(40 * k);
      const auto seen_now = [&](std::uint16_t index) { return ObservationId{{SensorId{0}, k}, index, set.time}; };
      for (std::size_t t = set.tracks.size(); t-- > 0;) {
        if (draw.uniform() < 0.85) continue;
        if (away.tracks.size() < away.tracks.capacity()) away.tracks.push_back(set.tracks[t]);
        set.tracks.erase(set.tracks.begin() + static_cast<std::ptrdiff_t>(t));
      }
      for (std::uint16_t i = 0; i < set.tracks.size(); ++i) {
        Track& track = set.tracks[i];
        if (draw.uniform() < 0.03) {  // with the same newest observation
          track.birth.measured = track.birth.measured - Duration{1 + draw.integer(0, 1) * 40'000'000 * 3};
          track.birth.index = static_cast<std::uint16_t>(100 + i);
          track.birth.measurement = {SensorId{1}, k};
          ++moved;
        } else if (draw.uniform() < 0.8) {
          track.newest = seen_now(i);
        }
        track.confirmed = draw.uniform() < (track.confirmed ? 0.95 : 0.3);
      }
      while (set.tracks.size() < most && !away.tracks.empty() && draw.uniform() < 0.3) {
        const auto back = static_cast<std::size_t>(draw.integer(0, static_cast<std::int64_t>(away.tracks.size()) - 1));
        set.tracks.push_back(away.tracks[back]);
        away.tracks.erase(away.tracks.begin() + static_cast<std::ptrdiff_t>(back));
        ++revived;
      }
      for (std::uint16_t i = 50; set.tracks.size() < most && draw.uniform() < 0.7; ++i) {
        Track& track = set.tracks.emplace_back();
        track.birth = track.newest = seen_now(i);
        track.confirmed = draw.uniform() < 0.2;
      }
      if (draw.uniform() < 0.8)
        std::sort(set.tracks.begin(), set.tracks.end(), [](const Track& a, const Track& b) {
          return before(a.birth.measurement, a.birth.measured, b.birth.measurement, b.birth.measured);
        });
      TrackSet again = set;
      const GlobalTime oldest = at_ms(40 * (static_cast<std::int64_t>(k) - 12));
      identities.name(set, oldest);
      plain.name(again, oldest);
      for (std::size_t t = 0; t < set.tracks.size(); ++t)
        ASSERT_EQ(set.tracks[t].id, again.tracks[t].id) << "seed " << seed << ", list " << k << ", track " << t;
    }
    forgotten += plain.forgotten;
  }
  EXPECT_GT(forgotten, 100u);
  EXPECT_GT(moved, 1000u);
  EXPECT_GT(revived, 1000u);
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
