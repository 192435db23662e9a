// Objects are never in one place, so tracks are not, either.
#include "fusion/tracks/parts/overlaps.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/errors.h"
#include "core/random.h"
#include "fusion/loading/tracker.h"
#include "fusion/tracks/footprint.h"
#include "fusion/tracks/parts/birth.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

config::TrackerConfig ending() {
  config::TrackerConfig config;
  config.end_overlaps = true;
  return config;
}

sensors::Observation car(double x, double y) {
  sensors::Observation z = position(x, y, 0.05);
  z.has_heading = z.has_length = z.has_width = true;
  z.heading = 0.0;
  z.length = 4.4;
  z.width = 1.8;
  z.sigma_heading = 0.02;
  z.sigma_length = z.sigma_width = 0.1;
  return z;
}

// Takes in ten lists, 100 ms apart, that `seen` makes.
template <class Seen> TrackSet after_ten(const config::TrackerConfig& config, const Seen& seen) {
  Bench bench(config);
  for (int k = 0; k < 10; ++k) bench.step(100 * k, seen(k));
  return bench.set;
}

using Cars = std::vector<sensors::Observation>;

// Two observations of one car in every list, 1.2 m apart.
Cars split_car(int) { return {car(20.0, 0.0), car(20.0, 1.2)}; }

TEST(Overlaps, OneCarInTwoPiecesHasOneTrack) {
  config::TrackerConfig keeping;
  keeping.end_overlaps = false;
  EXPECT_EQ(confirmed(after_ten(keeping, split_car)), 2);
  EXPECT_EQ(confirmed(after_ten(ending(), split_car)), 1);
}

TEST(Overlaps, CarsSideBySideAndBumperToBumperKeepTheirTracks) {
  const auto parked = [](int) -> Cars { return {car(20, 0), car(20, 2.3), car(24.7, 0)}; };
  EXPECT_EQ(confirmed(after_ten(ending(), parked)), 3);
}

// The second car drives into the place of the first one, which is not seen any more.
TEST(Overlaps, TheTrackThatIsNotSeenEnds) {
  const auto passing = [](int k) -> Cars {
    const double x = 35.0 - 1.5 * k;
    return k < 4 ? Cars{car(24.0, 0.0), car(x, 0.0)} : Cars{car(x, 0.0)};
  };
  config::TrackerConfig keeping;
  keeping.end_overlaps = false;
  const TrackSet kept = after_ten(keeping, passing), ended = after_ten(ending(), passing);
  EXPECT_EQ(confirmed(kept), 2);
  ASSERT_EQ(confirmed(ended), 1);
  EXPECT_EQ(ended.tracks[0].birth.index, 1) << "the younger one is seen";
}

// The car jumps by half of its length, out of its own gate: its new track continues the old one.
TEST(Overlaps, ATrackThatRefusesItsObjectIsReplacedAndKeepsItsIdentity) {
  Bench bench(ending());
  for (int k = 0; k < 20; ++k) bench.step(100 * k, {car(20.0, 0.0)});
  ASSERT_EQ(confirmed(bench.set), 1);
  const ObservationId birth = bench.set.tracks[0].birth;
  for (int k = 20; k < 24; ++k) bench.step(100 * k, {car(22.2, 0.0)});
  ASSERT_EQ(bench.set.tracks.size(), 1u);
  EXPECT_TRUE(bench.set.tracks[0].confirmed);
  EXPECT_TRUE(bench.set.tracks[0].birth == birth);
  EXPECT_NEAR(state_of(bench.set.tracks[0])(0), 22.2, 0.1);
}

// Oracle: all pairs, in order of birth. Cars are drawn over a square, so that some stand in others' places.
TEST(Overlaps, TheSearchFindsTheOverlapsOfAllPairs) {
  const config::TrackerConfig config = ending();
  const auto estimator = estimators::make_estimator(config);
  RandomStream stream({.seed = 5});
  int ended = 0;
  for (int drawn = 0; drawn < 40; ++drawn) {
    std::vector<Track> tracks;
    for (int k = 0; k < 25; ++k) {
      const sensors::Observation z = car(60.0 * stream.uniform(), 30.0 * stream.uniform());
      tracks.push_back(born(z, {{}, static_cast<std::uint16_t>(k), GlobalTime{}}, config, *estimator));
      tracks.back().confirmed = true;
      tracks.back().hits = k % 3 == 0 ? 0 : 1;
    }
    const auto footprint = [&](const Track& track) {
      return footprint_of(view_of(track, GlobalTime{}, GlobalTime{}, config, *estimator));
    };
    std::vector<char> left(tracks.size(), 1);
    for (std::size_t e = 0; e < tracks.size(); ++e)
      for (std::size_t y = e + 1; y < tracks.size(); ++y)
        if (left[e] && left[y] && overlap_depth(footprint(tracks[e]), footprint(tracks[y])) > 0.0)
          left[tracks[e].hits < tracks[y].hits ? e : y] = 0;  // all are as certain of their places
    std::vector<std::uint16_t> expected, found;
    for (std::size_t k = 0; k < tracks.size(); ++k)
      if (left[k]) expected.push_back(tracks[k].birth.index);
    Overlaps overlaps(tracks.size());
    overlaps.end(tracks, GlobalTime{}, config, *estimator);
    for (const Track& track : tracks) found.push_back(track.birth.index);
    EXPECT_EQ(found, expected) << drawn;
    ended += static_cast<int>(25 - found.size());
  }
  EXPECT_GT(ended, 100);
}

TEST(Overlaps, OtherMethodsForLateListsAreRefused) {
  const StrictYaml yaml = StrictYaml::parse("{overlaps: end, late: al1}", "test.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  loading::load_tracker(root);
  root.finish();
  ASSERT_EQ(findings.size(), 1);
  EXPECT_EQ(findings.list()[0].key, "late");
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
