// Objects out of view are left out, with an image's objects on them.
#include "evaluation/accuracy/judged_objects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "evaluation/accuracy/drive_measures.h"
#include "tests/evaluation/accuracy/synthetic_uses.h"

namespace ttf::evaluation::accuracy {
namespace {

using Points = std::vector<fusion::metrics::Point>;
using Places = std::vector<std::size_t>;

// Object 1 is hidden with a track on it, object 3 without one. Object 0 has a track, object 2 has none. Another track is on no object.
TEST(JudgedObjects, LeaveOutWithTheirTracks) {
  const Points truths{{10, 0}, {20, 0}, {30, 0}, {60, 0}}, shown{{20.5, 0}, {100, 0}, {11, 0}};
  const JudgedObjects judged = judged_objects(truths, {true, false, true, false}, shown, 4.0);
  EXPECT_EQ(judged.truths, (Places{0, 2}));
  EXPECT_EQ(judged.shown, (Places{1, 2}));
  ASSERT_EQ(judged.pairs.size(), 1u);
  EXPECT_EQ(judged.pairs[0].truth, 0u);
  EXPECT_EQ(judged.pairs[0].estimate, 2u);
}

// A track between two objects belongs to the nearer one, in view or not.
TEST(JudgedObjects, ATrackIsOnTheObjectThatItsPairHas) {
  const Points truths{{10, 0}, {13, 0}};
  for (const double x : {11.0, 12.0}) {
    const JudgedObjects judged = judged_objects(truths, {true, false}, Points{{x, 0}}, 4.0);
    EXPECT_EQ(judged.truths, (Places{0}));
    EXPECT_EQ(judged.pairs.size(), x < 11.5 ? 1u : 0u);
    EXPECT_EQ(judged.shown.size(), x < 11.5 ? 1u : 0u);
  }
}

TEST(JudgedObjects, InViewTheyAreAllWithThePairsOfAll) {
  for (std::uint32_t index = 0; index < 200; ++index) {
    RandomStream draw({.seed = 72, .purpose = Purpose::kTest, .index = index});
    Points truths(static_cast<std::size_t>(draw.integer(0, 9))), shown(static_cast<std::size_t>(draw.integer(0, 9)));
    for (Points* points : {&truths, &shown})
      for (fusion::metrics::Point& point : *points) point = {draw.uniform(0.0, 20.0), draw.uniform(0.0, 6.0)};
    const JudgedObjects judged = judged_objects(truths, std::vector(truths.size(), true), shown, 4.0);
    const auto pairs = fusion::metrics::object_pairs(truths, shown, 4.0);
    EXPECT_EQ(judged.truths.size(), truths.size());
    EXPECT_EQ(judged.shown.size(), shown.size());
    ASSERT_EQ(judged.pairs.size(), pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_EQ(judged.pairs[i].truth, pairs[i].truth);
      EXPECT_EQ(judged.pairs[i].estimate, pairs[i].estimate);
    }
  }
}

struct Track {
  std::uint16_t name;
  double x;
};
void use_at(DriveMeasures& measures, std::int64_t ms, const std::vector<Track>& tracks) {
  std::vector<recording::records::FeatureObject> objects;
  for (const Track& track : tracks) objects.push_back({{TrackId{track.name}, track.x, 0.0}, 0, 0, false});
  recording::records::FeatureUsed used;
  used.stamp = {at(ms), {}, GlobalTime{at(ms).ns}, {}};
  used.objects = objects;
  measures.on(used);
}
void truth_at(DriveMeasures& measures, std::int64_t ms, std::uint16_t object, double x, bool out_of_view) {
  recording::records::TruthState truth;
  truth.at = at(ms);
  truth.object = ObjectId{object};
  truth.x = x;
  truth.out_of_view = out_of_view;
  measures.on(truth);
}

//   instant   object 1, at 10 m      object 2, at 30 m        track elsewhere
//   0         track 7, off 1         track 8, off 2
//   1         track 7, off 1         hidden, no track
//   2         track 7, off 1         hidden, track 9, off 3   5, 60 m off
//   3         missed                 track 9, off 2
// Object 2 comes back with another track: one switch. Hidden it has no error, no miss and no break, and track 9 is not false then.
TEST(JudgedObjects, ADriveByHand) {
  DriveMeasures measures(TrueTime{});
  const std::vector<Track> tracks[]{{{7, 11}, {8, 32}}, {{7, 11}}, {{7, 11}, {9, 33}, {5, 90}}, {{9, 32}}};
  for (std::int64_t i = 0; i < 4; ++i) {
    use_at(measures, 40 * i, tracks[i]);
    truth_at(measures, 40 * i, 1, 10.0, false);
    truth_at(measures, 40 * i, 2, 30.0, i == 1 || i == 2);
  }
  const DriveSummary summary = measures.finish();
  EXPECT_EQ(summary.matched, 5u);
  EXPECT_EQ(summary.missed, 1u);
  EXPECT_EQ(summary.spurious, 1u);
  EXPECT_EQ(summary.out_of_view, 2u);
  EXPECT_EQ(summary.shown_out_of_view, 1u);
  EXPECT_NEAR(summary.rmse_truth[0], std::sqrt((1.0 + 4.0 + 1.0 + 1.0 + 4.0) / 5.0), 1e-12);
  const TrackingMeasures& all = summary.tracking;
  EXPECT_EQ(all.mot.objects, 6u);
  EXPECT_EQ(all.mot.matches, 5u);
  EXPECT_EQ(all.mot.misses, 1u);
  EXPECT_EQ(all.mot.false_positives, 1u);
  EXPECT_EQ(all.mot.switches, 1u);
  EXPECT_NEAR(all.mot.mota(), 1.0 - 3.0 / 6.0, 1e-12);
  EXPECT_EQ(all.lives.fragmentations, 0u);
  EXPECT_NEAR(all.lives.mean_fraction_tracked, (3.0 / 4.0 + 1.0) / 2.0, 1e-12);
  // GOSPA^2: 1 + 4; 1; 1 + 8; 4 + 8.
  EXPECT_NEAR(all.gospa.localisation, (5.0 + 1.0 + 1.0 + 4.0) / 4.0, 1e-12);
  EXPECT_NEAR(all.gospa.missed, 8.0 / 4.0, 1e-12);
  EXPECT_NEAR(all.gospa.false_estimates, 8.0 / 4.0, 1e-12);
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
