// CLEAR-MOT: published sequences, sequences by hand, and a plain second implementation on drawn ones.
#include "fusion/metrics/clear_mot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::metrics {
namespace {

using Names = std::vector<Identity>;
using Distances = std::vector<double>;
constexpr double kNo = std::numeric_limits<double>::quiet_NaN();

ClearMot judge(double gate_m = 10.0) { return ClearMot(gate_m); }

struct Expected {
  std::uint64_t matches, misses, false_positives, switches;
};
void expect_counts(const ClearMotCounts& counts, const Expected& expected) {
  EXPECT_EQ(counts.matches, expected.matches);
  EXPECT_EQ(counts.misses, expected.misses);
  EXPECT_EQ(counts.false_positives, expected.false_positives);
  EXPECT_EQ(counts.switches, expected.switches);
}

// (object, track) of the matches.
using Pairs = std::vector<std::pair<Identity, Identity>>;
Pairs pairs_of(std::span<const Match> matches) {
  Pairs pairs;
  for (const Match& match : matches) pairs.emplace_back(match.object, match.track);
  return pairs;
}

// py-motmetrics, motmetrics/tests/test_metrics.py: test_mota_motp. (It counts switches apart from matches: 4 and 2.)
TEST(ClearMotPublished, MotaAndMotp) {
  ClearMot mot = judge();
  mot.step(Names{}, Names{1, 2}, Distances{});
  mot.step(Names{1, 2}, Names{}, Distances{});
  mot.step(Names{1, 2}, Names{1, 2}, Distances{1, 0.5, 0.3, 1});
  mot.step(Names{1, 2}, Names{1, 2}, Distances{0.2, kNo, kNo, 0.1});
  EXPECT_EQ(pairs_of(mot.step(Names{1, 2}, Names{1, 2}, Distances{5, 1, 1, 5})), (Pairs{{1, 1}, {2, 2}}));
  mot.step(Names{}, Names{}, Distances{});
  expect_counts(mot.counts(), {.matches = 6, .misses = 2, .false_positives = 2, .switches = 2});
  EXPECT_EQ(mot.counts().objects, 8u);
  EXPECT_EQ(mot.counts().tracks, 8u);
  EXPECT_EQ(mot.counts().instants, 6u);
  EXPECT_DOUBLE_EQ(mot.counts().mota(), 1.0 - (2.0 + 2.0 + 2.0) / 8.0);
  EXPECT_NEAR(mot.counts().motp_m(), 11.1 / 6.0, 1e-15);
}

// The same file: test_ids.
TEST(ClearMotPublished, Ids) {
  ClearMot mot = judge();
  mot.step(Names{}, Names{}, Distances{});
  mot.step(Names{1, 2}, Names{1, 2}, Distances{1, 0, 0, 1});
  mot.step(Names{1, 2}, Names{1, 2}, Distances{0.4, kNo, kNo, 0.4});
  mot.step(Names{1, 2}, Names{1, 2}, Distances{0, 1, 1, 0});
  mot.step(Names{1, 2}, Names{2, 3}, Distances{1, 0, 0.4, 0.7});
  mot.step(Names{1, 3}, Names{2, 3}, Distances{1, 0, 0.4, 0.7});
  mot.step(Names{}, Names{}, Distances{});
  expect_counts(mot.counts(), {.matches = 10, .misses = 0, .false_positives = 0, .switches = 3});
  EXPECT_DOUBLE_EQ(mot.counts().mota(), 1.0 - 3.0 / 10.0);
  EXPECT_NEAR(mot.counts().motp_m(), 1.6 / 10.0, 1e-15);
}

// The same file: test_correct_average, after figure 3 of the paper. It sums over all instants and takes no
// mean of ratios.
TEST(ClearMotPublished, CorrectAverage) {
  ClearMot mot = judge();
  for (int i = 0; i < 4; ++i) mot.step(Names{1, 2, 3, 4}, Names{}, Distances{});
  for (int i = 0; i < 4; ++i) mot.step(Names{4}, Names{4}, Distances{0});
  EXPECT_DOUBLE_EQ(mot.counts().mota(), 0.2);
}

// The same file: test_metrics_with_no_events, and the three with empty lists.
TEST(ClearMotPublished, NothingToJudge) {
  EXPECT_TRUE(std::isnan(judge().counts().mota()));
  EXPECT_TRUE(std::isnan(judge().counts().motp_m()));
  ClearMot no_truth = judge(), no_tracks = judge(), nothing = judge();
  for (int i = 0; i < 4; ++i) {
    no_truth.step(Names{}, Names{1, 2, 3, 4}, Distances{});
    no_tracks.step(Names{1, 2, 3, 4}, Names{}, Distances{});
    nothing.step(Names{}, Names{}, Distances{});
  }
  expect_counts(no_truth.counts(), {0, 0, 16, 0});
  expect_counts(no_tracks.counts(), {0, 16, 0, 0});
  expect_counts(nothing.counts(), {0, 0, 0, 0});
  EXPECT_EQ(nothing.counts().instants, 4u);
}

// py-motmetrics, README.md, "Populating the accumulator" and "Computing metrics".
TEST(ClearMotPublished, Readme) {
  ClearMot mot = judge();
  EXPECT_EQ(pairs_of(mot.step(Names{1, 2}, Names{1, 2, 3}, Distances{0.1, kNo, 0.3, 0.5, 0.2, 0.3})),
            (Pairs{{1, 1}, {2, 2}}));
  EXPECT_EQ(pairs_of(mot.step(Names{1, 2}, Names{1}, Distances{0.2, 0.4})), (Pairs{{1, 1}}));
  EXPECT_DOUBLE_EQ(mot.counts().mota(), 0.5);
  EXPECT_NEAR(mot.counts().motp_m(), 0.166667, 5e-7);
  EXPECT_EQ(pairs_of(mot.step(Names{1, 2}, Names{1, 3}, Distances{0.6, 0.2, 0.1, 0.6})), (Pairs{{1, 1}, {2, 3}}));
  EXPECT_DOUBLE_EQ(mot.counts().mota(), 0.5);
  EXPECT_NEAR(mot.counts().motp_m(), 0.34, 1e-15);
  expect_counts(mot.counts(), {.matches = 5, .misses = 1, .false_positives = 1, .switches = 1});
}

//   t        0    1    2         two objects meet and part; the tracks go on as if they had crossed:
//   object   1 -2 ... 0 ... -2   each is nearer to the other's object at the end,
//   object   2  2 ... 0 ...  2   but within the gate of its own: it is kept, and there is no switch
TEST(ClearMot, KeepsTheMatchWhereAnotherTrackIsCloser) {
  ClearMot mot = judge(5.0);
  const std::vector<Named> objects{{1, {-2, 0}}, {2, {2, 0}}};
  mot.step(objects, std::vector<Named>{{7, {-2, 0}}, {8, {2, 0}}});
  mot.step(std::vector<Named>{{1, {0, 0}}, {2, {0, 0}}}, std::vector<Named>{{7, {0, 0}}, {8, {0, 0}}});
  const auto last = mot.step(objects, std::vector<Named>{{7, {2, 0}}, {8, {-2, 0}}});
  EXPECT_EQ(pairs_of(last), (Pairs{{1, 7}, {2, 8}}));
  EXPECT_DOUBLE_EQ(mot.counts().motp_m(), 8.0 / 6.0);
  expect_counts(mot.counts(), {6, 0, 0, 0});
}

// The same beyond the gate: two switches at one instant, then no more while it stays so.
TEST(ClearMot, SwitchesBeyondTheGateOnce) {
  ClearMot mot = judge(3.0);
  const std::vector<Named> objects{{1, {-2, 0}}, {2, {2, 0}}};
  mot.step(objects, std::vector<Named>{{7, {-2, 0}}, {8, {2, 0}}});
  for (int i = 0; i < 3; ++i) {
    const auto matches = mot.step(objects, std::vector<Named>{{7, {2, 0}}, {8, {-2, 0}}});
    EXPECT_EQ(pairs_of(matches), (Pairs{{1, 8}, {2, 7}}));
    for (const Match& match : matches) EXPECT_EQ(match.switched, i == 0);
  }
  expect_counts(mot.counts(), {8, 0, 0, 2});
}

TEST(ClearMot, TheGateItselfBelongs) {
  ClearMot mot = judge(2.0);
  EXPECT_EQ(mot.step(Names{1}, Names{1}, Distances{2.0}).size(), 1u);
  EXPECT_EQ(mot.step(Names{1}, Names{1}, Distances{std::nextafter(2.0, 3.0)}).size(), 0u);
  expect_counts(mot.counts(), {1, 1, 1, 0});
}

// After misses: the same track again is no switch, another one is. The instants between do not matter.
TEST(ClearMot, RemembersAcrossMisses) {
  for (const Identity later : {5u, 6u}) {
    ClearMot mot = judge();
    mot.step(Names{1}, Names{5}, Distances{0.1});
    for (int i = 0; i < 3; ++i) mot.step(Names{1}, Names{}, Distances{});
    for (int i = 0; i < 2; ++i) mot.step(Names{}, Names{}, Distances{});  // out of sight: not a miss
    mot.step(Names{1}, Names{later}, Distances{0.1});
    expect_counts(mot.counts(), {2, 3, 0, later == 6 ? 1u : 0u});
  }
}

// The first object loses its track, which later follows the second. When all are near, the track stays with
// the second. Neither distance nor the smaller name matters.
TEST(ClearMot, ATrackThatSeveralHadStaysWithTheLast) {
  for (const bool swapped : {false, true}) {
    ClearMot mot = judge();
    const Identity first = swapped ? 2 : 1, second = swapped ? 1 : 2;
    mot.step(Names{first}, Names{5}, Distances{0.1});
    mot.step(Names{second}, Names{5}, Distances{3.0});
    EXPECT_EQ(pairs_of(mot.step(Names{first, second}, Names{5}, Distances{0.1, 4.0})), (Pairs{{second, 5}}));
    expect_counts(mot.counts(), {3, 1, 0, 0});
  }
}

//             track 1  track 2      nearest first: 1-1 and nothing for 2
//   object 1    0.1      0.9
//   object 2    0.2      beyond
TEST(ClearMot, AsManyAsCanBeThenTheNearest) {
  ClearMot mot = judge(1.0);
  EXPECT_EQ(pairs_of(mot.step(Names{1, 2}, Names{1, 2}, Distances{0.1, 0.9, 0.2, 1.1})), (Pairs{{1, 2}, {2, 1}}));
}

TEST(ClearMot, TiesGoToTheSmallerNames) {
  ClearMot one_track = judge(), one_object = judge(), two = judge();
  EXPECT_EQ(pairs_of(one_track.step(Names{4, 3}, Names{9}, Distances{0.5, 0.5})), (Pairs{{3, 9}}));
  EXPECT_EQ(pairs_of(one_object.step(Names{3}, Names{9, 8}, Distances{0.5, 0.5})), (Pairs{{3, 8}}));
  EXPECT_EQ(pairs_of(two.step(Names{4, 3}, Names{8, 9}, Distances{1, 1, 1, 1})), (Pairs{{3, 8}, {4, 9}}));
}

// The rules in a plain second implementation: maps and recursion over all ways to pair. It shares only types
// with the code under test.
class PlainClearMot {
 public:
  explicit PlainClearMot(double gate_m) : gate_(gate_m) {}

  Pairs step(const std::vector<Named>& objects, const std::vector<Named>& tracks) {
    ++instant_;
    std::map<Identity, Identity> track_of, object_of;
    for (const Named& track : tracks) {
      std::optional<Identity> holder;
      for (const Named& object : objects) {
        const auto last = last_.find(object.name);
        if (last == last_.end() || last->second.first != track.name) continue;
        if (distance_m(object.at, track.at) > gate_) continue;
        if (!holder || last->second.second > last_.at(*holder).second) holder = object.name;
      }
      if (!holder) continue;
      track_of[*holder] = track.name;
      object_of[track.name] = *holder;
    }
    std::vector<Named> others, free;
    for (const Named& object : objects)
      if (!track_of.contains(object.name)) others.push_back(object);
    for (const Named& track : tracks)
      if (!object_of.contains(track.name)) free.push_back(track);
    best_ = {};
    best_sum_ = 0.0;
    try_all(others, free, 0, 0, 0.0, {});
    for (const auto& [object, track] : best_) track_of[object] = track;

    Pairs pairs(track_of.begin(), track_of.end());
    for (const auto& [object, track] : pairs) {
      const auto last = last_.find(object);
      if (last != last_.end() && last->second.first != track) ++switches;
      last_[object] = {track, instant_};
    }
    return pairs;
  }

  int switches = 0;

 private:
  void try_all(const std::vector<Named>& objects, const std::vector<Named>& tracks, std::size_t object, unsigned taken,
               double sum, const Pairs& pairs) {
    if (object == objects.size()) {
      if (pairs.size() > best_.size() || (pairs.size() == best_.size() && sum < best_sum_)) {
        best_ = pairs;
        best_sum_ = sum;
      }
      return;
    }
    try_all(objects, tracks, object + 1, taken, sum, pairs);
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      const double distance = distance_m(objects[object].at, tracks[t].at);
      if (taken >> t & 1u || distance > gate_) continue;
      Pairs more = pairs;
      more.emplace_back(objects[object].name, tracks[t].name);
      try_all(objects, tracks, object + 1, taken | 1u << t, sum + distance, more);
    }
  }

  double gate_;
  int instant_ = 0;
  std::map<Identity, std::pair<Identity, int>> last_;
  Pairs best_;
  double best_sum_ = 0.0;
};

// Some of `count` walkers, in drawn order, each named by its number and `offset`.
class Walkers {
 public:
  Walkers(std::size_t count, Identity offset, RandomStream& stream) : stream_(stream) {
    for (std::size_t i = 0; i < count; ++i)
      all_.push_back({offset + static_cast<Identity>(i), {stream.uniform(0, 8), stream.uniform(0, 8)}});
  }
  std::vector<Named> step() {
    std::vector<Named> seen;
    for (Named& one : all_) {
      one.at = {one.at.x + stream_.uniform(-1, 1), one.at.y + stream_.uniform(-1, 1)};
      if (stream_.uniform() < 0.8)
        seen.insert(seen.begin() + stream_.integer(0, static_cast<std::int64_t>(seen.size())), one);
    }
    return seen;
  }

 private:
  RandomStream& stream_;
  std::vector<Named> all_;
};

// C1 to C4 on drawn sequences; the same, listed backwards, gives the same.
TEST(ClearMot, IsItsRulesWrittenPlainly) {
  int switches = 0;
  for (std::uint32_t index = 0; index < 120; ++index) {
    RandomStream stream({.seed = 41, .purpose = Purpose::kTest, .index = index});
    Walkers objects(5, 0, stream), tracks(5, 100, stream);
    ClearMot mot = judge(3.0), backwards = judge(3.0);
    PlainClearMot plain(3.0);
    for (int instant = 0; instant < 40; ++instant) {
      const std::vector<Named> o = objects.step(), t = tracks.step();
      const Pairs pairs = pairs_of(mot.step(o, t));
      ASSERT_EQ(pairs, plain.step(o, t)) << index << " at " << instant;
      ASSERT_EQ(pairs, pairs_of(backwards.step(std::vector<Named>(o.rbegin(), o.rend()),
                                               std::vector<Named>(t.rbegin(), t.rend()))));
    }
    ASSERT_EQ(mot.counts().switches, static_cast<std::uint64_t>(plain.switches)) << index;
    ASSERT_EQ(mot.counts().distance_sum_m, backwards.counts().distance_sum_m);
    ASSERT_EQ(mot.counts().matches + mot.counts().misses, mot.counts().objects);
    ASSERT_EQ(mot.counts().matches + mot.counts().false_positives, mot.counts().tracks);
    switches += plain.switches;
  }
  EXPECT_GT(switches, 500) << "nothing happens";
}

// The second pass finds all storage there.
TEST(ClearMot, AllocatesNothingOnceItHasSeenTheLargest) {
  RandomStream stream({.seed = 42, .purpose = Purpose::kTest});
  Walkers objects(8, 0, stream), tracks(8, 100, stream);
  std::vector<std::vector<Named>> seen;
  for (int i = 0; i < 60; ++i) seen.push_back(i % 2 == 0 ? objects.step() : tracks.step());
  ClearMot mot = judge(3.0);
  std::int64_t before = 0;
  for (const int pass : {1, 2}) {
    if (pass == 2) before = support::allocations();
    for (std::size_t i = 0; i < seen.size(); i += 2) mot.step(seen[i], seen[i + 1]);
  }
  EXPECT_EQ(support::allocations(), before);
  EXPECT_GT(mot.counts().matches, 50u);
}

TEST(ClearMotDeathTest, ListsAreChecked) {
  ClearMot mot = judge(1.0);
  EXPECT_DEATH(mot.step(Names{1, 1}, Names{}, Distances{}), "1 listed twice");
  EXPECT_DEATH(mot.step(Names{}, Names{2, 1, 2}, Distances{}), "2 listed twice");
  EXPECT_DEATH(mot.step(Names{1}, Names{1, 2}, Distances{0.5}), "1 distances of 1 x 2");
  EXPECT_DEATH(judge(0.0), "gate 0 m");
}

}  // namespace
}  // namespace ttf::fusion::metrics
