// The reading of a track among several classes: a car's rear or a motorbike's side.
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "fusion/tracks/parts/classes.h"
#include "fusion/tracks/timeline.h"
#include "tests/fusion/class_reports.h"
#include "tests/fusion/scenes.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::tracks::parts {
namespace {

using sensors::SeenPoint;

config::TrackerConfig choosing(std::initializer_list<std::string_view> names = {}) {
  config::TrackerConfig config = with_classes(names);
  config.gate_probability = 0.9999;
  return config;
}

// A face that a laser calls an end.
sensors::Observation end_of(double x, double y, double size, double sigma) {
  sensors::Observation z = position(x, y, 0.03);
  z.seen = SeenPoint::kEnd;
  z.has_heading = z.has_width = true;
  z.sigma_heading = 0.02;
  z.width = size;
  z.sigma_width = sigma;
  return z;
}

bool lies_along(const Track& track, double axis) {
  return track.heading.known && std::abs(std::cos(track.heading.value - axis)) > 0.7;
}

double density_of(double off, double variance) { return std::exp(-0.5 * off * off / variance) / std::sqrt(variance); }

// Oracle: Bayes' theorem for one face, that is a width or a length, of an object without a course.
TEST(Readings, OddsOfOneFaceAreThoseOfBayesTheorem) {
  constexpr double kSigma = 0.03;
  config::TrackerConfig config = choosing({"car", "motorbike"});
  config.initial_turn_rate_sigma = 0.0;  // a turn would tell the axes apart
  const config::ClassPrior &car = config.classes[0], &motorbike = config.classes[1];
  const auto estimator = estimators::make_estimator(config);
  int sides = 0;
  for (double size = 1.5; size < 2.5; size += 0.05) {
    Bench bench(config);
    bench.step(0, {end_of(20.0, 0.0, size, kSigma)});
    ASSERT_EQ(bench.set.tracks.size(), 1u);
    double as_width = 0.0, as_length = 0.0;
    for (const config::ClassPrior* one : {&car, &motorbike}) {
      const config::Sizes& sizes = one->sizes;
      as_width += one->share * density_of(size - sizes.width, sizes.width_sigma * sizes.width_sigma + kSigma * kSigma);
      as_length +=
          one->share * density_of(size - sizes.length, sizes.length_sigma * sizes.length_sigma + kSigma * kSigma);
    }
    const double odds = std::log(as_length / as_width);
    sides += odds > 0.0;
    EXPECT_TRUE(lies_along(bench.set.tracks[0], odds > 0.0 ? 0.5 * kPi : 0.0)) << size << " m, odds " << odds;
    EXPECT_NEAR(log_odds_of_other_reading(bench.set.tracks[0], config, *estimator), -std::abs(odds), 1e-6);
  }
  EXPECT_GT(sides, 2);
  EXPECT_LT(sides, 18);
}

// A two-wheeler of 1.6 m to 2.5 m passes with 5 m/s. Its side is an end by its length, and twice in ten lists a corner.
double share_of_right_axes(const config::TrackerConfig& config, bool report) {
  constexpr int kDrives = 300;
  RandomStream stream({.seed = 7});
  int right = 0;
  for (int drive = 0; drive < kDrives; ++drive) {
    const bool motorbike = drive % 2 == 0;
    const config::Sizes& sizes = config::kClassPriors[motorbike ? 3 : 4].sizes;
    const double length = sizes.length + sizes.length_sigma * stream.normal();
    const double repeating = 0.03 * stream.normal();
    Bench bench(config);
    for (int k = 0; k < 20; ++k) {
      sensors::Observation z = end_of(25.0 + 0.03 * stream.normal(), -8.0 + 0.25 * k + 0.03 * stream.normal(),
                                      length + repeating + 0.03 * stream.normal(), 0.05);
      z.heading = 0.02 * stream.normal();
      if (k % 5 == 3) {
        z.seen = SeenPoint::kCorner;
        z.z(1) += 0.5 * length;  // the nearer one, of an object to the right
      }
      bench.step(50 * k, {report ? reported(z, motorbike ? 3u : 4u) : z});
    }
    const Track& track = bench.set.tracks.at(0);
    right += lies_along(track, 0.5 * kPi) && std::abs(track.extent.size(0) - length) < 0.2;
  }
  return static_cast<double>(right) / kDrives;
}

TEST(Readings, ATwoWheelerAcrossLiesAlongItsCourse) {
  EXPECT_GT(share_of_right_axes(choosing(), false), 0.99);
  EXPECT_GT(share_of_right_axes(choosing(), true), 0.99);
  EXPECT_LT(share_of_right_axes(choosing({"car"}), false), 0.5) << "the figure depends on the choice of classes";
}

// Also of cars that stand, which have no course.
TEST(Readings, ACarsRearStaysAnEnd) {
  constexpr int kDrives = 300;
  for (const double speed : {0.0, 5.0}) {
    RandomStream stream({.seed = 8});
    const config::Sizes& car = config::kClassPriors[0].sizes;
    int right = 0;
    for (int drive = 0; drive < kDrives; ++drive) {
      const double width = car.width + car.width_sigma * stream.normal();
      Bench bench(choosing());
      for (int k = 0; k < 20; ++k)
        bench.step(50 * k, {end_of(20.0 + speed * 0.05 * k + 0.03 * stream.normal(), 0.03 * stream.normal(),
                                   width + 0.03 * stream.normal(), 0.05)});
      right += lies_along(bench.set.tracks.at(0), 0.0);
    }
    EXPECT_GT(right, speed > 0.0 ? 0.995 * kDrives : 0.98 * kDrives) << speed << " m/s";
  }
}

// Lists of a motorbike across, whose track is read anew by its course and by the reports.
std::vector<OwnedList> passing() {
  std::vector<OwnedList> lists;
  for (int k = 0; k < 12; ++k)
    lists.push_back(list_of(0, static_cast<std::uint32_t>(k), at_ms(50 * k),
                            {end_of(25.0, -4.0 + 0.25 * k, k < 6 ? 1.95 : 2.0, 0.05)}));
  return lists;
}

TEST(Readings, ATrackReadAnewKeepsIdentityPointAndMotion) {
  const config::TrackerConfig config = choosing();
  const std::vector<OwnedList> lists = passing();
  Bench bench(config), one(choosing({"car"}));
  bool anew = false;
  for (const OwnedList& list : lists) {
    bench.tracker.step(bench.set, list.view());
    one.tracker.step(one.set, list.view());
    ASSERT_EQ(bench.set.tracks.size(), 1u);
    const Track &track = bench.set.tracks[0], &other = one.set.tracks[0];
    ASSERT_TRUE(track.birth == other.birth);
    ASSERT_TRUE(same_bits(track.estimate, other.estimate)) << "the same point of the same face";
    const bool along_course = lies_along(track, 0.5 * kPi);
    ASSERT_TRUE(along_course || !anew) << "a track that is read anew stays so";
    anew = along_course;
    ASSERT_EQ(track.anchor.point, along_course ? SeenPoint::kSide : SeenPoint::kEnd);
  }
  EXPECT_TRUE(anew);
  EXPECT_EQ(bench.set.tracks[0].heading.front, std::sin(bench.set.tracks[0].heading.value) > 0.0 ? 1 : -1);
}

TEST(Readings, LateListsGiveTheBitsOfArrivalInOrder) {
  const config::TrackerConfig config = choosing();
  const std::vector<OwnedList> lists = passing();
  Timeline in_order(config, 4);
  for (const OwnedList& list : lists) in_order.insert(list.view());
  ASSERT_TRUE(lies_along(in_order.current().tracks[0], 0.5 * kPi));
  for (std::size_t late = 0; late + 1 < lists.size(); ++late) {
    Timeline timeline(config, 4);
    for (std::size_t k = 0; k < lists.size(); ++k)
      if (k != late) timeline.insert(lists[k].view());
    ASSERT_EQ(timeline.insert(lists[late].view()), Timeline::Insertion::kLate);
    const Track &a = timeline.current().tracks[0], &b = in_order.current().tracks[0];
    ASSERT_TRUE(same_bits(timeline.current(), in_order.current())) << late;
    ASSERT_EQ(a.heading.value, b.heading.value) << late;
    ASSERT_EQ(a.extent.size, b.extent.size) << late;
    ASSERT_EQ(a.class_index, b.class_index) << late;
  }
}

TEST(Readings, NothingIsAllocated) {
  const std::vector<OwnedList> lists = passing();
  Bench bench(choosing());
  const std::int64_t before = support::allocations();
  for (const OwnedList& list : lists) bench.tracker.step(bench.set, list.view());
  EXPECT_EQ(support::allocations() - before, 0);
  EXPECT_TRUE(lies_along(bench.set.tracks[0], 0.5 * kPi));
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
