// The class of an object by share, sizes, reports and speed.
#include "fusion/tracks/parts/classes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "fusion/motion/angles.h"
#include "tests/fusion/class_reports.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

std::string class_of(const Bench& bench) {
  if (bench.set.tracks.size() != 1) return "not one track";
  return std::string(bench.config.classes.at(bench.set.tracks[0].class_index).name);
}

bool same_extents(const Track& a, const Track& b) {
  return a.extent.size == b.extent.size && a.extent.covariance == b.extent.covariance &&
         a.extent.prior_variances == b.extent.prior_variances;
}

// Its rear, 20 m ahead.
sensors::Observation rear(double width, double sigma) {
  sensors::Observation z = position(20.0, 0.0, 0.1);
  z.seen = sensors::SeenPoint::kEnd;
  z.has_heading = z.has_width = true;
  z.sigma_heading = 0.02;
  z.width = width;
  z.sigma_width = sigma;
  return z;
}

// An outline that shows so many metres, 20 m ahead.
sensors::Observation silhouette(double shown) {
  sensors::Observation z = position(20.0, 0.0, 0.3);
  z.seen = sensors::SeenPoint::kSilhouette;
  z.has_span = true;
  z.span = shown / 20.0;
  z.sigma_span = 0.002;
  return z;
}

TEST(Classes, ATrucksRearMakesATruckAndLeavesTheAnchorsEstimate) {
  Bench bench(with_classes()), without;
  for (int k = 0; k < 20; ++k) {
    bench.step(50 * k, {rear(2.5, 0.1)});
    without.step(50 * k, {rear(2.5, 0.1)});
    ASSERT_EQ(class_of(bench), "truck") << k;
    ASSERT_EQ(without.set.tracks.size(), 1u);
    const Track &track = bench.set.tracks[0], &other = without.set.tracks[0];
    ASSERT_TRUE(same_bits(track.estimate, other.estimate)) << k;
    ASSERT_EQ(track.heading.value, other.heading.value);
    ASSERT_TRUE(track.anchor == other.anchor);
  }
  const body::Extent& extent = bench.set.tracks[0].extent;
  EXPECT_NEAR(extent.size(0), 12.0, 1e-9) << "of which nothing is measured";
  EXPECT_NEAR(extent.covariance(0, 0), 2.5 * 2.5, 1e-9);
  EXPECT_NEAR(extent.size(1), 2.5, 0.01);
  EXPECT_NEAR(without.set.tracks[0].extent.size(0), 4.4, 1e-9);
}

TEST(Classes, ACarStaysACar) {
  Bench bench(with_classes()), without;
  for (int k = 0; k < 20; ++k) {
    bench.step(50 * k, {rear(1.8, 0.1)});
    without.step(50 * k, {rear(1.8, 0.1)});
    ASSERT_EQ(class_of(bench), "car") << k;
    ASSERT_TRUE(same_extents(bench.set.tracks[0], without.set.tracks[0])) << k;
  }
}

// Oracle: Bayes' theorem for one face, whose size is normal about the mean of its class. First the more probable reading, of a width or a
// length, by the sum over all classes; then the most probable class.
TEST(Classes, OneFaceAndReportsGiveTheMostProbableReadingAndClass) {
  config::TrackerConfig config = with_classes();
  config.initial_turn_rate_sigma = 0.0;  // a turn would tell the axes apart
  constexpr double kSigma = 0.03;
  int lengths = 0;
  for (std::size_t report = 0; report <= config::kClassCount; ++report)
    for (double size = 0.3; size < 3.0; size += 0.0137) {
      std::string most_probable[2];
      double sums[2] = {}, most[2] = {};
      for (const config::ClassPrior& one : config.classes)
        for (const int length : {0, 1}) {
          const double sigma = length ? one.sizes.length_sigma : one.sizes.width_sigma;
          const double variance = sigma * sigma + kSigma * kSigma;
          const double off = size - (length ? one.sizes.length : one.sizes.width);
          double probability = one.share * std::exp(-0.5 * off * off / variance) / std::sqrt(variance);
          if (report < config::kClassCount)
            probability *= one.name == config.classes[report].name ? 0.95 : 0.05 / (config::kClassCount - 1);
          sums[length] += probability;
          if (probability <= most[length]) continue;
          most[length] = probability;
          most_probable[length] = one.name;
        }
      const int length = sums[1] > sums[0];
      lengths += length;
      Bench bench(config);
      const sensors::Observation z = rear(size, kSigma);
      bench.step(0, {report < config::kClassCount ? reported(z, report) : z});
      ASSERT_EQ(class_of(bench), most_probable[length]) << size << " m, reported as " << report;
      ASSERT_EQ(std::abs(bench.set.tracks[0].heading.value) > 1.0, length == 1) << size << " m, reported as " << report;
    }
  EXPECT_GT(lengths, 100);
}

TEST(Classes, ReportsOutweighAShare) {
  Bench silent(with_classes()), with_report(with_classes());
  silent.step(0, {rear(1.9, 0.1)});
  with_report.step(0, {reported(rear(1.9, 0.1), 2)});
  EXPECT_EQ(class_of(silent), "car") << "of both that may be so wide, the more frequent one";
  EXPECT_EQ(class_of(with_report), "van");
  EXPECT_NEAR(with_report.set.tracks[0].extent.size(0), 5.5, 1e-9);
}

TEST(Classes, OneWrongReportInTwentyListsChangesNothing) {
  for (std::size_t wrong = 1; wrong < config::kClassCount; ++wrong)
    for (int at = 1; at < 20; ++at) {
      Bench bench(with_classes()), right(with_classes());
      for (int k = 0; k < 20; ++k) {
        bench.step(50 * k, {reported(rear(1.8, 0.1), k == at ? wrong : 0)});
        right.step(50 * k, {reported(rear(1.8, 0.1), 0)});
        ASSERT_EQ(class_of(bench), "car") << "list " << k << ", wrong in " << at << " as " << wrong;
        ASSERT_TRUE(same_extents(bench.set.tracks[0], right.set.tracks[0]));
      }
    }
}

// A class that no sensor reports: all reports are of others.
TEST(Classes, AClassWithoutReportsIsUnlikelierWithEachReport) {
  config::TrackerConfig config = with_classes({"car", "truck"});
  config.classes[0].id = sensors::ClassId{5};
  config.classes[1].id = sensors::kNoClass;
  Bench bench(config);
  bench.step(0, {rear(2.5, 0.1)});
  EXPECT_EQ(class_of(bench), "truck");
  for (int k = 1; k < 10; ++k) bench.step(50 * k, {reported(rear(2.5, 0.1), 5)});
  EXPECT_EQ(class_of(bench), "car");
}

// No side of a car, a van or a truck is as small. With a measured axis, or with none.
TEST(Classes, AnOutlineOfLessThanACarsWidthIsNoCarFromAnyAspect) {
  constexpr int kAspects = 24;
  for (int aspect = -1; aspect < kAspects; ++aspect) {
    Bench bench(with_classes());
    for (int k = 0; k < 10; ++k) {
      sensors::Observation z = silhouette(0.6);
      z.has_heading = aspect >= 0;
      z.heading = motion::to_half_turn(aspect * 2.0 * std::numbers::pi / kAspects);
      z.sigma_heading = 0.05;
      bench.step(50 * k, {z});
      const std::string name = class_of(bench);
      ASSERT_TRUE(name == "motorbike" || name == "cyclist" || name == "pedestrian") << name << ", aspect " << aspect;
    }
  }
}

// Widths, lengths, spans and reports of all kinds of objects, one after the other.
std::vector<sensors::Observation> mixed() {
  std::vector<sensors::Observation> all;
  for (std::size_t k = 0; k < 24; ++k) {
    sensors::Observation z =
        k % 3 == 2 ? silhouette(0.4 + 0.2 * static_cast<double>(k)) : rear(0.5 + 0.1 * static_cast<double>(k), 0.1);
    if (k % 3 == 1) {
      z.has_length = true;
      z.length = 1.0 + 0.5 * static_cast<double>(k);
      z.sigma_length = 0.2;
    }
    all.push_back(reported(z, k % config::kClassCount));
  }
  return all;
}

TEST(Classes, WithoutAChoiceTheExtentStaysAsItIs) {
  Bench without, one(with_classes({"car"}));
  std::int64_t ms = 0;
  for (const sensors::Observation& z : mixed()) {
    without.step(ms, {z});
    one.step(ms, {z});
    ms += 50;
    ASSERT_EQ(without.set.tracks.size(), 1u);
    ASSERT_TRUE(same_bits(without.set, one.set));
    ASSERT_TRUE(same_extents(without.set.tracks[0], one.set.tracks[0]));
    for (const Bench* bench : {&without, &one}) {
      Track track = bench->set.tracks[0];
      const SeenSpan span{linear::Vector<2>(-20.0, 0.0), 0.03, 0.002};
      choose_class(track, bench->config, *estimators::make_estimator(bench->config), &span);
      ASSERT_TRUE(same_extents(track, bench->set.tracks[0]));
      ASSERT_EQ(track.class_index, 0);
    }
  }
}

// Each in the middle between both widths. A motorbike is less frequent.
TEST(Classes, ASpeedDecidesBetweenMotorbikeAndPedestrianOnlyOverGround) {
  for (const bool over_ground : {false, true})
    for (const double speed : {0.5, 10.0}) {
      config::TrackerConfig config = with_classes({"motorbike", "pedestrian"});
      if (over_ground) config.odometry.emplace();
      Bench bench(config);
      for (int k = 0; k < 20; ++k) {
        sensors::Observation z = rear(0.7, 0.1);
        z.z(0) += speed * 0.05 * k;
        bench.step(50 * k, {z});
      }
      EXPECT_EQ(class_of(bench), over_ground && speed > 5.0 ? "motorbike" : "pedestrian")
          << speed << " m/s" << (over_ground ? ", with odometry" : "");
    }
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
