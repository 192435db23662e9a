// Two tracks of one object become one; two objects side by side do not.
#include "fusion/tracks/parts/twins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "fusion/tracks/timeline.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

config::TrackerConfig uniting(double probability = 0.99) {
  config::TrackerConfig config;
  config.merge_probability = probability;
  config.merge_scans = 4;
  config.end_overlaps = false;  // it would come first
  config.delete_misses = 30;
  return config;
}

// A car drives ahead at 5 m/s. The laser sees its rear; the camera first places it further away, so that each
// has a track. As the car approaches and both agree, the tracks merge.
//
//   camera's view  ------____
//   laser's view   ==========------  one
std::vector<OwnedList> two_views() {
  std::vector<OwnedList> lists;
  RandomStream stream({.seed = 4});
  for (std::uint32_t k = 0; k < 200; ++k) {
    const double t = 0.02 * k, truth = 20.0 + 5.0 * t, off = std::max(0.0, 3.0 - 1.5 * t);
    const auto see = [&](double x, double sigma) {
      return std::vector{position(x + sigma * stream.normal(), sigma * stream.normal(), sigma)};
    };
    const bool laser = k % 2 == 0;
    lists.push_back(list_of(laser ? 0 : 1, k / 2, at_ms(20 * k), laser ? see(truth, 0.1) : see(truth + off, 0.2)));
  }
  return lists;
}

TEST(Twins, LasersAndCamerasViewsOfOneObjectBecomeOne) {
  for (const config::Association association : {config::Association::kNearest, config::Association::kJpda})
    for (const config::Birth birth : {config::Birth::kMOfN, config::Birth::kExistence}) {
      config::TrackerConfig config = uniting();
      config.association = association;
      config.birth = birth;
      config.detection_probability = 0.5;  // every other list is one sensor's (fusion/tracks/parts/existence.h)
      Timeline united(config, 8);
      TrackId first = kNoTrack;
      int most = 0;
      bool were_united = false;
      for (const OwnedList& s : two_views()) {
        const int before = confirmed(united.current());
        const bool both_live =
            std::all_of(united.current().tracks.begin(), united.current().tracks.end(),
                        [](const Track& t) { return !t.confirmed || (t.misses < 10 && t.existence > 0.5); });
        united.insert(s.view());
        const int after = confirmed(united.current());
        most = std::max(most, after);
        were_united = were_united || (before == 2 && after == 1 && both_live);
        if (first == kNoTrack && after == 1) first = united.current().tracks[0].id;
      }
      EXPECT_EQ(most, 2) << "each view had its track";
      EXPECT_TRUE(were_united) << "neither was about to end by itself: " << static_cast<int>(association)
                               << static_cast<int>(birth);
      ASSERT_EQ(confirmed(united.current()), 1);
      EXPECT_EQ(united.current().tracks[0].id, first) << "the older identity stays";
      const estimators::State x = state_of(united.current().tracks[0]);
      EXPECT_NEAR(x(0), 20.0 + 5.0 * 0.02 * 199, 0.3);
      EXPECT_NEAR(x(2), 5.0, 1.5);
    }
}

// Two cars 2 m apart and a sensor that distinguishes them: over hundreds of lists, with gates wide enough to
// touch.
TEST(Twins, CarsSideBySideStayTwo) {
  for (const config::Association association : {config::Association::kNearest, config::Association::kJpda}) {
    config::TrackerConfig config = uniting(0.999999);
    config.association = association;
    config.merge_scans = 1;
    Tracker tracker(config, 8);
    TrackSet set(tracker.max_tracks());
    RandomStream stream({.seed = 6});
    for (std::uint32_t k = 0; k < 400; ++k) {
      const double x = 20.0 + 0.2 * k, sigma = 0.3;
      std::vector<sensors::Observation> list;
      for (const double y : {-1.0, 1.0})
        list.push_back(position(x + sigma * stream.normal(), y + sigma * stream.normal(), sigma));
      tracker.step(set, list_of(0, k, at_ms(40 * k), list).view());
      if (k >= 5) {
        ASSERT_GE(confirmed(set), 2) << k;
      }
    }
  }
}

// Confirmed, at 3 m/s along x.
Track track_at(double x, double y, double sigma, std::uint32_t birth) {
  Track track;
  track.birth = track.newest = {{SensorId{0}, birth}, 0, at_ms(static_cast<std::int64_t>(birth))};
  linear::Matrix<4> p = linear::Matrix<4>::Identity() * sigma * sigma;
  track.estimate = linear::Gaussian<4>{linear::Vector<4>(x, y, 3.0, 0.0), p};
  track.confirmed = true;
  track.lists = 10;
  return track;
}

// A list in which these tracks had an observation.
OwnedList list_of_tracks(std::initializer_list<Track*> seen) {
  static std::uint32_t number = 100;
  ++number;
  const OwnedList list = list_of(0, number, at_ms(number));
  for (Track* track : seen) track->newest = {list.id, 0, list.measured};
  return list;
}

TEST(Twins, TheElderStaysAndTheMoreCertainEstimateIsKept) {
  config::TrackerConfig config = uniting();
  config.merge_scans = 2;
  const auto estimator = estimators::make_estimator(config);
  Twins twins(config, 8);
  std::vector<Track> tracks{track_at(20.0, 0.0, 0.4, 1), track_at(50.0, 5.0, 0.4, 2), track_at(20.2, 0.1, 0.1, 3)};
  tracks[0].unfiltered.classes.add(sensors::ClassId{2}, 1.5);
  tracks[2].unfiltered.classes.add(sensors::ClassId{2}, 2.0);
  tracks[2].unfiltered.third = {.z = 1.25, .height = 0.0, .has_z = true, .has_height = false};
  tracks[0].existence = 0.9;
  tracks[2].existence = 0.99;
  tracks[0].misses = 5;
  tracks[2].hits = 0b111;
  correct_width(tracks[2].extent, 1.9, 0.1);
  tracks[2].class_index = 3;
  const estimators::Estimate certain = tracks[2].estimate;
  twins.unite(tracks, list_of_tracks({&tracks[2]}).view(), *estimator);
  ASSERT_EQ(tracks.size(), 3u) << "one list is not enough";
  EXPECT_EQ(tracks[2].twin_lists, 1);
  const OwnedList last = list_of_tracks({&tracks[2]});
  twins.unite(tracks, last.view(), *estimator);
  ASSERT_EQ(tracks.size(), 2u);
  EXPECT_EQ(tracks[0].birth.measurement.sequence, 1u);
  EXPECT_TRUE(same_bits(tracks[0].estimate, certain));
  EXPECT_EQ(tracks[0].newest.measurement, last.id);
  EXPECT_EQ(tracks[0].unfiltered.classes.sums[2], 3.5);
  EXPECT_EQ(tracks[0].unfiltered.third.z, 1.25);
  EXPECT_EQ(tracks[0].existence, 0.99);
  EXPECT_EQ(tracks[0].misses, 0);
  EXPECT_NEAR(tracks[0].extent.size(1), 1.9, 0.05);
  EXPECT_EQ(tracks[0].class_index, 3) << "the class goes with the extent";
  EXPECT_EQ(tracks[1].birth.measurement.sequence, 2u);
}

TEST(Twins, AListThatShowsBothBeginsTheCountAnew) {
  config::TrackerConfig config = uniting();
  config.merge_scans = 3;
  const auto estimator = estimators::make_estimator(config);
  Twins twins(config, 8);
  std::vector<Track> tracks{track_at(20.0, 0.0, 0.4, 1), track_at(20.2, 0.1, 0.4, 2)};
  const auto list = [&](bool elder, bool younger) {
    const OwnedList shown = list_of_tracks({});
    for (std::size_t t = 0; t < 2; ++t)
      if (t == 0 ? elder : younger) tracks[t].newest = {shown.id, 0, shown.measured};
    twins.unite(tracks, shown.view(), *estimator);
  };
  list(true, false);
  list(false, true);
  EXPECT_EQ(tracks[1].twin_lists, 2);
  list(false, false);
  EXPECT_EQ(tracks[1].twin_lists, 2) << "who saw neither says nothing";
  list(true, true);
  EXPECT_EQ(tracks[1].twin_lists, 0) << "two objects";
  list(true, false);
  list(true, false);
  ASSERT_EQ(tracks.size(), 2u);
  list(true, false);
  EXPECT_EQ(tracks.size(), 1u);
}

TEST(Twins, AnotherSizeIsAnotherObject) {
  config::TrackerConfig config = uniting();
  config.merge_scans = 1;
  const auto estimator = estimators::make_estimator(config);
  Twins twins(config, 8);
  std::vector<Track> lorry_and_car{track_at(20.0, 0.0, 0.4, 1), track_at(20.2, 0.1, 0.4, 2)};
  correct_length(lorry_and_car[0].extent, 9.0, 0.1);
  correct_length(lorry_and_car[1].extent, 4.0, 0.1);
  const OwnedList list = list_of_tracks({&lorry_and_car[0]});
  std::vector<Track> unmeasured = lorry_and_car;
  unmeasured[1].extent = body::Extent();
  twins.unite(lorry_and_car, list.view(), *estimator);
  EXPECT_EQ(lorry_and_car.size(), 2u);
  twins.unite(unmeasured, list.view(), *estimator);
  EXPECT_EQ(unmeasured.size(), 1u) << "of which the size is not known";
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
