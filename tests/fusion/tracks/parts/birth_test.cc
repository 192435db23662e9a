// Births of tracks, one by one.
#include "fusion/tracks/parts/birth.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

TEST(Birth, TheSecondEchoOfAConfirmedTrackIsNoNewObject) {
  Bench bench;
  for (int k = 0; k < 6; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.3)});
  ASSERT_EQ(confirmed(bench.set), 1);
  bench.step(300, {position(20.05, 0.0, 0.3), position(19.8, 0.1, 0.3), position(40.0, 5.0, 0.3)});
  ASSERT_EQ(bench.set.tracks.size(), 2u);
  EXPECT_NEAR(state_of(bench.set.tracks[1])(0), 40.0, 1e-12);
}

// Takes in ten lists of one observation each, of these weights.
TrackSet after_ten(const std::function<double(int)>& weight) {
  Bench bench;
  for (int k = 0; k < 10; ++k) {
    sensors::Observation z = position(20.0, 0.0, 0.05);
    z.weight = weight(k);
    bench.step(100 * k, {z});
  }
  return bench.set;
}

TEST(Birth, DoubtfulObservationsBeginNoTrackButUpdateOne) {
  EXPECT_TRUE(after_ten([](int) { return 0.25; }).tracks.empty());
  const TrackSet set = after_ten([](int k) { return k < 3 ? 1.0 : 0.25; });
  ASSERT_EQ(confirmed(set), 1);
  EXPECT_EQ(set.tracks[0].misses, 0);
  EXPECT_EQ(confirmed(after_ten([](int k) { return k == 0 ? 1.0 : 0.25; })), 0) << "sure once: that confirms nothing";
}

TEST(Birth, TheEndOfACutOutlineBeginsNoTrack) {
  Bench bench;
  sensors::Observation z = position(20.0, 0.0, 0.05);
  z.seen = sensors::SeenPoint::kLeftmost;
  for (int k = 0; k < 10; ++k) bench.step(100 * k, {z});
  EXPECT_TRUE(bench.set.tracks.empty());
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
