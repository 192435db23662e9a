// GOSPA, OSPA, CLEAR-MOT and lives over a sequence: by hand. A missed object costs.
#include "evaluation/accuracy/tracking_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"

namespace ttf::evaluation::accuracy {
namespace {

using fusion::metrics::Named;
using Set = std::vector<Named>;

TrueTime instant(int i) { return TrueTime{} + Duration::milliseconds(40 * i); }

TEST(TrackingJudge, OfNothingIsNoNumber) {
  const TrackingMeasures none = TrackingJudge({4.0, 2.0}, 4.0).measures();
  EXPECT_EQ(none.instants, 0u);
  EXPECT_TRUE(std::isnan(none.gospa.distance_m));
  EXPECT_TRUE(std::isnan(none.ospa.distance_m));
  EXPECT_TRUE(std::isnan(none.mot.mota()));
  EXPECT_TRUE(std::isnan(none.lives.mean_fraction_tracked));
  EXPECT_EQ(none.cut_off.distance_m, 4.0);
}

//   instant   object 1          object 2       track elsewhere
//   0         track 7, off 1    track 8, off 2
//   1         track 7, off 1    missed         9, 50 m off
//   2         track 9, off 1    track 8, off 2
// c = 4, p = 2. GOSPA^2: 1 + 4; 1 + 8 + 8; 1 + 4. OSPA^2: 5 / 2; (1 + 16) / 2; 5 / 2.
TEST(TrackingJudge, ThreeInstantsByHand) {
  TrackingJudge judge({4.0, 2.0}, 4.0);
  const Set objects{{1, {10, 0}}, {2, {30, 0}}};
  judge.judge(instant(0), objects, Set{{7, {11, 0}}, {8, {30, 2}}});
  judge.judge(instant(1), objects, Set{{7, {11, 0}}, {9, {30, 50}}});
  judge.judge(instant(2), objects, Set{{9, {11, 0}}, {8, {30, 2}}});
  judge.judge(instant(2), objects, Set{});  // the same instant again
  const TrackingMeasures all = judge.measures();
  EXPECT_EQ(all.instants, 3u);
  EXPECT_NEAR(all.gospa.localisation, 11.0 / 3.0, 1e-12);
  EXPECT_NEAR(all.gospa.missed, 8.0 / 3.0, 1e-12);
  EXPECT_NEAR(all.gospa.false_estimates, 8.0 / 3.0, 1e-12);
  EXPECT_NEAR(all.gospa.distance_m, std::sqrt(9.0), 1e-12);
  EXPECT_NEAR(all.ospa.distance_m, std::sqrt((2.5 + 8.5 + 2.5) / 3.0), 1e-12);
  EXPECT_EQ(all.ospa.cardinality, 0.0);
  EXPECT_EQ(all.mot.matches, 5u);
  EXPECT_EQ(all.mot.misses, 1u);
  EXPECT_EQ(all.mot.false_positives, 1u);
  EXPECT_EQ(all.mot.switches, 1u);
  EXPECT_NEAR(all.mot.mota(), 1.0 - 3.0 / 6.0, 1e-12);
  EXPECT_NEAR(all.mot.motp_m(), (1 + 2 + 1 + 1 + 2) / 5.0, 1e-12);
  EXPECT_EQ(all.lives.objects, 2u);
  EXPECT_EQ(all.lives.fragmentations, 1u);
  EXPECT_EQ(all.lives.lost, 2u);  // one to another track, one to a gap
  EXPECT_NEAR(all.lives.mean_fraction_tracked, (1.0 + 2.0 / 3.0) / 2.0, 1e-12);
}

// A damaged log may repeat a name. GOSPA counts both, CLEAR-MOT the first.
TEST(TrackingJudge, RepeatedNamesCountOnceForTheLives) {
  TrackingJudge judge({4.0, 2.0}, 4.0);
  judge.judge(instant(0), Set{{1, {10, 0}}, {1, {30, 0}}}, Set{{7, {10, 0}}, {7, {30, 0}}});
  const TrackingMeasures all = judge.measures();
  EXPECT_EQ(all.gospa.distance_m, 0.0);
  EXPECT_EQ(all.mot.matches, 1u);
  EXPECT_EQ(all.mot.objects, 1u);
  EXPECT_EQ(all.lives.objects, 1u);
}

// Drawn scenes have one estimate near each object, and false ones far off. Without a near one all measures are worse.
TEST(TrackingJudge, AMissedObjectMakesThemWorse) {
  for (std::uint32_t index = 0; index < 200; ++index) {
    RandomStream draw({.seed = 71, .purpose = Purpose::kTest, .index = index});
    const fusion::metrics::CutOff cut_off{4.0, index % 2 == 0 ? 2.0 : 1.0};
    const double near = cut_off.distance_m / std::pow(2.0, 1.0 / cut_off.order);
    const auto count = draw.integer(1, 8);
    Set objects, tracks;
    for (std::int64_t i = 0; i < count; ++i) {
      const auto name = static_cast<fusion::metrics::Identity>(i);
      objects.push_back({name, {20.0 * static_cast<double>(i), 0}});
      tracks.push_back({name, {objects.back().at.x + draw.uniform(-0.99, 0.99) * near, 0}});
    }
    Set fewer(tracks.begin(), tracks.end());
    fewer.erase(fewer.begin() + draw.integer(0, count - 1));
    for (Set* shown : {&tracks, &fewer})
      for (std::int64_t i = 0; i < index % 3; ++i) shown->push_back({100u + static_cast<unsigned>(i), {0, 50}});
    TrackingJudge whole(cut_off, 4.0), missing(cut_off, 4.0);
    whole.judge(instant(0), objects, tracks);
    missing.judge(instant(0), objects, fewer);
    const TrackingMeasures with = whole.measures(), without = missing.measures();
    ASSERT_GT(without.gospa.distance_m, with.gospa.distance_m) << index;
    ASSERT_GT(without.gospa.missed, with.gospa.missed);
    ASSERT_LE(without.gospa.localisation, with.gospa.localisation) << "the pairs alone look better";
    ASSERT_LT(without.mot.mota(), with.mot.mota());
    ASSERT_GT(without.mot.misses, with.mot.misses);
    ASSERT_LT(without.lives.mean_fraction_tracked, with.lives.mean_fraction_tracked);
    if (index % 3 == 0) {
      ASSERT_GT(without.ospa.distance_m, with.ospa.distance_m) << "no false tracks";
    }
  }
}

// A thousand separated objects for some seconds: every one keeps its track.
TEST(TrackingJudge, AThousandObjectsKeepTheirTracks) {
  TrackingJudge judge({4.0, 2.0}, 4.0);
  RandomStream draw({.seed = 72, .purpose = Purpose::kTest});
  for (int i = 0; i < 20; ++i) {
    Set objects, tracks;
    for (fusion::metrics::Identity k = 0; k < 1000; ++k) {
      objects.push_back({k, {10.0 * (k % 40), 10.0 * (k / 40)}});
      tracks.push_back({2000 - k, {objects.back().at.x + draw.uniform(-1, 1), objects.back().at.y}});
    }
    judge.judge(instant(i), objects, tracks);
  }
  const TrackingMeasures all = judge.measures();
  EXPECT_EQ(all.mot.mota(), 1.0);
  EXPECT_EQ(all.lives.mostly_tracked, 1000u);
  EXPECT_NEAR(all.gospa.distance_m, std::sqrt(1000.0 / 3.0), 0.5);
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
