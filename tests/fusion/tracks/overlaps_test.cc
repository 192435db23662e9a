// Objects are never in one place, so tracks are not, either. Doubtful observations begin and confirm no track.
#include "fusion/tracks/overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/errors.h"
#include "fusion/loading/tracker.h"
#include "fusion/tracks/footprint.h"
#include "fusion/tracks/tracker.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks {
namespace {

config::TrackerConfig ending() {
  config::TrackerConfig config;
  config.end_overlaps = true;
  return config;
}

sensors::Observation car(double x, double y, double weight = 1.0) {
  sensors::Observation z = position(x, y, 0.05);
  z.has_heading = z.has_length = z.has_width = true;
  z.heading = 0.0;
  z.length = 4.4;
  z.width = 1.8;
  z.sigma_heading = 0.02;
  z.sigma_length = z.sigma_width = 0.1;
  z.weight = weight;
  return z;
}

// Takes in ten lists, 100 ms apart, that `seen` makes.
template <class Seen> TrackSet after_ten(const config::TrackerConfig& config, const Seen& seen) {
  Tracker tracker(config, 8);
  TrackSet set(tracker.max_tracks());
  for (std::uint32_t k = 0; k < 10; ++k) {
    const OwnedList list = list_of(0, k, at_ms(100 * static_cast<int>(k)), seen(k));
    tracker.step(set, list.view());
  }
  return set;
}

std::size_t confirmed(const TrackSet& set) {
  return static_cast<std::size_t>(
      std::count_if(set.tracks.begin(), set.tracks.end(), [](const Track& t) { return t.confirmed; }));
}

using Cars = std::vector<sensors::Observation>;

TEST(OverlapDepth, IsThatOfTheShortestWayApart) {
  const Footprint at_origin{0, 0, 0, 4, 2};
  EXPECT_NEAR(overlap_depth(at_origin, {3, 0, 0, 4, 2}), 1.0, 1e-12);
  EXPECT_NEAR(overlap_depth(at_origin, {5, 0, 0, 4, 2}), -1.0, 1e-12);
  EXPECT_NEAR(overlap_depth(at_origin, {0, 1.5, 0, 4, 2}), 0.5, 1e-12);
  EXPECT_NEAR(overlap_depth(at_origin, {0, 3.5, 1.5707963267948966, 4, 2}), -0.5, 1e-12);
  // Their axes' boxes overlap, they do not: a corner looks past a corner.
  EXPECT_LT(overlap_depth(at_origin, {3.4, 2.6, 0.785398163, 4, 2}), 0.0);
  EXPECT_NEAR(overlap_depth(at_origin, {1, 0.3, 0.4, 3, 1}), overlap_depth({1, 0.3, 0.4, 3, 1}, at_origin), 1e-12);
}

// Two observations of one car in every list, 1.2 m apart.
Cars split_car(std::uint32_t) { return {car(20.0, 0.0), car(20.0, 1.2)}; }

TEST(Overlaps, OneCarInTwoPiecesHasOneTrack) {
  config::TrackerConfig keeping;
  EXPECT_EQ(confirmed(after_ten(keeping, split_car)), 2U);
  EXPECT_EQ(confirmed(after_ten(ending(), split_car)), 1U);
}

TEST(Overlaps, CarsSideBySideAndBumperToBumperKeepTheirTracks) {
  const auto parked = [](std::uint32_t) -> Cars { return {car(20, 0), car(20, 2.3), car(24.7, 0)}; };
  EXPECT_EQ(confirmed(after_ten(ending(), parked)), 3U);
}

// The second car drives into the place of the first one, which is not seen any more.
TEST(Overlaps, TheTrackThatIsNotSeenEnds) {
  const auto passing = [](std::uint32_t k) -> Cars {
    const double x = 35.0 - 1.5 * k;
    return k < 4 ? Cars{car(24.0, 0.0), car(x, 0.0)} : Cars{car(x, 0.0)};
  };
  const TrackSet kept = after_ten({}, passing), ended = after_ten(ending(), passing);
  EXPECT_EQ(confirmed(kept), 2U);
  ASSERT_EQ(confirmed(ended), 1U);
  EXPECT_EQ(ended.tracks[0].birth.index, 1U) << "the younger one is seen";
}

TEST(Doubtful, ObservationsBeginNoTrackButUpdateOne) {
  const auto doubtful = [](std::uint32_t) -> Cars { return {car(20, 0, 0.25)}; };
  EXPECT_TRUE(after_ten({}, doubtful).tracks.empty());
  // Sure in three of the first lists, doubtful afterwards.
  const auto later = [](std::uint32_t k) -> Cars { return {car(20, 0, k < 3 ? 1.0 : 0.25)}; };
  const TrackSet set = after_ten({}, later);
  ASSERT_EQ(confirmed(set), 1U);
  EXPECT_EQ(set.tracks[0].misses, 0);
  // Sure once: that confirms nothing.
  const auto once = [](std::uint32_t k) -> Cars { return {car(20, 0, k == 0 ? 1.0 : 0.25)}; };
  EXPECT_EQ(confirmed(after_ten({}, once)), 0U);
}

TEST(Doubtful, ExistenceGrowsMoreSlowly) {
  config::TrackerConfig config;
  config.birth = config::Birth::kExistence;
  config.clutter_density = 0.05;
  // Seen in the last two lists.
  const auto of_weight = [&](double weight) {
    return after_ten(config, [&](std::uint32_t k) { return k < 8 ? Cars{} : Cars{car(20, 0, weight)}; });
  };
  const TrackSet sure = of_weight(1.0), doubtful = of_weight(0.3);
  ASSERT_EQ(sure.tracks.size(), 1U);
  ASSERT_EQ(doubtful.tracks.size(), 1U);
  EXPECT_LT(doubtful.tracks[0].existence, sure.tracks[0].existence);
  // The odds have the weight twice: at birth, and in the list after it.
  const auto odds = [](double existence) { return existence / (1.0 - existence); };
  EXPECT_LT(odds(doubtful.tracks[0].existence), 0.3 * odds(sure.tracks[0].existence));
}

TEST(Overlaps, OtherMethodsForLateListsAreRefused) {
  const StrictYaml yaml = StrictYaml::parse("{overlaps: end, late: al1}", "test.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  loading::load_tracker(root);
  root.finish();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.list()[0].key, "late");
}

}  // namespace
}  // namespace ttf::fusion::tracks
