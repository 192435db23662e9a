// Emulated cars with known pose and size: their seen points, headings and sizes.
#include "sensors/laser/rectangle_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "sensors/laser/preprocessor.h"
#include "sensors/laser/segmentation.h"
#include "sensors/shape.h"
#include "tests/sensors/laser/emulated_scan.h"

namespace ttf::sensors::laser {
namespace {

using ttf::fusion::sensors::SeenPoint;

// Through segmentation.
LaserObject fitted(const sim::world::ObjectState& car, std::uint32_t sequence, const LaserConfig& laser = {},
                   const LaserPreprocessingConfig& preprocessing = {}) {
  LaserPreprocessor preprocessor(preprocessing, kMostPoints);
  std::vector<LaserObject> objects;
  preprocessor.process(emulated_scan(laser, {car}, sequence), objects);
  EXPECT_GE(objects.size(), 1U) << "a car at " << car.x << " " << car.y << " heading " << car.heading;
  // A side seen very flatly is cut off: the rear has more returns.
  const auto most = std::max_element(objects.begin(), objects.end(),
                                     [](const auto& a, const auto& b) { return a.points < b.points; });
  return objects.empty() ? LaserObject{} : *most;
}

struct Point {
  double x, y;
};

// Returns where the point is that was seen, from the true rectangle and the sensor at the origin.
Point truth_of(const sim::world::ObjectState& car, SeenPoint seen) {
  const double c = std::cos(car.heading), s = std::sin(car.heading);
  if (seen == SeenPoint::kSilhouette) {
    constexpr int kRays = 400;
    const auto span = azimuth_span(car);
    const RayTarget target(car);
    double sum = 0.0;
    int hits = 0;
    for (int i = 0; i < kRays; ++i)
      if (const auto range = target.ray_to(span->low + (span->high - span->low) * (i + 0.5) / kRays)) {
        sum += *range;
        ++hits;
      }
    const double range = sum / hits, azimuth = 0.5 * (span->low + span->high);
    return {range * std::cos(azimuth), range * std::sin(azimuth)};
  }
  const bool end = seen == SeenPoint::kEnd || seen == SeenPoint::kCorner;
  const bool side = seen == SeenPoint::kSide || seen == SeenPoint::kCorner;
  const double along = end ? -std::copysign(0.5 * car.length, car.x * c + car.y * s) : 0.0;
  const double across = side ? -std::copysign(0.5 * car.width, car.y * c - car.x * s) : 0.0;
  return {car.x + along * c - across * s, car.y + along * s + across * c};
}

// Heading of a long axis is known up to half a turn.
double axis_difference(double a, double b) { return std::remainder(a - b, std::numbers::pi); }

double squared_distance(const LaserObject& o, double ex, double ey) {
  const double determinant = o.sxx * o.syy - o.sxy * o.sxy;
  return (o.syy * ex * ex - 2.0 * o.sxy * ex * ey + o.sxx * ey * ey) / determinant;
}

void expect_positive_definite(const LaserObject& o) {
  EXPECT_GT(o.sxx, 0.0);
  EXPECT_GT(o.syy, 0.0);
  EXPECT_GT(o.sxx * o.syy - o.sxy * o.sxy, 0.0);
}

TEST(RectangleFit, AnLShapeGivesItsCornerAndSize) {
  LaserConfig exact;
  exact.range_sigma_m = exact.miss_at_100m = 0.0;
  for (const double heading : {0.5, 0.8, 1.1, -0.6, -0.9}) {
    const auto car = car_at(15.0, 0.0, heading);
    const LaserObject o = fitted(car, 0, exact);
    ASSERT_EQ(o.seen, SeenPoint::kCorner) << heading;
    ASSERT_TRUE(o.has_heading && o.has_length && o.has_width) << heading;
    EXPECT_NEAR(axis_difference(o.heading, heading), 0.0, 1e-4) << heading;
    EXPECT_NEAR(o.length, 4.4, 0.12) << heading;
    EXPECT_NEAR(o.width, 1.8, 0.12) << heading;
    const Point corner = truth_of(car, SeenPoint::kCorner);
    EXPECT_NEAR(o.x, corner.x, 1e-3) << heading;
    EXPECT_NEAR(o.y, corner.y, 1e-3) << heading;
  }
}

TEST(RectangleFit, ARearAloneIsItsMiddle) {
  for (const double x : {10.0, 20.0, 40.0}) {
    const LaserObject o = fitted(car_at(x, 0.0, 0.0), 1);
    ASSERT_EQ(o.seen, SeenPoint::kEnd);
    EXPECT_FALSE(o.has_length);
    EXPECT_TRUE(o.has_width);
    EXPECT_EQ(o.length, 0.0);
    EXPECT_NEAR(o.width, 1.8, 3.0 * o.sigma_width);
    EXPECT_NEAR(axis_difference(o.heading, 0.0), 0.0, 3.0 * o.sigma_heading);
    // The mean of some returns of 6 cm; sideways, the beams' spacing.
    EXPECT_NEAR(o.x, x - 2.2, 3.0 * std::sqrt(o.sxx));
    EXPECT_LT(std::sqrt(o.sxx), 0.02);
    EXPECT_LT(std::sqrt(o.syy), 0.05);
  }
}

TEST(RectangleFit, ASideAloneIsItsMiddle) {
  const LaserObject o = fitted(car_at(15.0, 0.0, std::numbers::pi / 2), 1);
  ASSERT_EQ(o.seen, SeenPoint::kSide);
  EXPECT_TRUE(o.has_length);
  EXPECT_FALSE(o.has_width);
  EXPECT_EQ(o.width, 0.0);
  EXPECT_NEAR(o.length, 4.4, 3.0 * o.sigma_length);
  EXPECT_NEAR(axis_difference(o.heading, std::numbers::pi / 2), 0.0, 3.0 * o.sigma_heading);
  EXPECT_NEAR(o.x, 15.0 - 0.9, 3.0 * std::sqrt(o.sxx));
}

TEST(RectangleFit, AFewReturnsAreASilhouette) {
  const double azimuth = std::atan2(3.0, 40.0), range = std::hypot(40.0, 3.0);
  const std::vector<PlanePoint> points = {{40.0, 3.0, azimuth, range}};
  const LaserObject o = fit_rectangle({}, points);
  EXPECT_EQ(o.seen, SeenPoint::kSilhouette);
  EXPECT_FALSE(o.has_heading || o.has_length || o.has_width);
  expect_positive_definite(o);
  EXPECT_NEAR(o.x, 40.0, 1e-9);
  EXPECT_NEAR(o.y, 3.0, 1e-9);
  // Half a beam's step to either side of both ends.
  EXPECT_NEAR(std::sqrt(o.syy), range * RectangleConfig{}.azimuth_step_rad / std::sqrt(24.0), 0.01);
}

// A pole, a person, a motorcycle's rear: no vehicle's face.
TEST(RectangleFit, ANarrowObjectIsASilhouette) {
  for (const double width : {0.4, 0.7, 1.0})
    for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
      const auto object = car_at(15.0, 3.0, 0.1, 0.6, width);
      const LaserObject o = fitted(object, sequence);
      EXPECT_EQ(o.seen, SeenPoint::kSilhouette) << width;
      const Point truth = truth_of(object, SeenPoint::kSilhouette);
      EXPECT_LT(squared_distance(o, o.x - truth.x, o.y - truth.y), 25.0) << width;
    }
}

TEST(RectangleFit, TurningTheSceneTurnsTheAnswer) {
  std::vector<PlanePoint> points, turned;
  std::vector<Segment> segments;
  segment_scan({}, emulated_scan({}, {car_at(18.0, 2.0, 0.7)}, 4), points, segments);
  const double angle = 0.4321, c = std::cos(angle), s = std::sin(angle);
  for (const PlanePoint& p : points)
    turned.push_back({c * p.x - s * p.y, s * p.x + c * p.y, p.azimuth + angle, p.range});
  const LaserObject a = fit_rectangle({}, points), b = fit_rectangle({}, turned);
  ASSERT_EQ(a.seen, SeenPoint::kCorner);
  ASSERT_EQ(b.seen, SeenPoint::kCorner);
  EXPECT_NEAR(axis_difference(b.heading - a.heading, angle), 0.0, 1e-6);
  EXPECT_NEAR(b.x, c * a.x - s * a.y, 1e-5);
  EXPECT_NEAR(b.y, s * a.x + c * a.y, 1e-5);
}

// Squared errors over their variances.
struct Mean {
  double sum = 0.0;
  int count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double mean() const { return sum / count; }
};

// The errors for one kind of seen point.
struct Consistency {
  Mean point, heading, length, width;
  void add(const LaserObject& o, const sim::world::ObjectState& car) {
    const Point truth = truth_of(car, o.seen);
    point.add(0.5 * squared_distance(o, o.x - truth.x, o.y - truth.y));
    const auto squared = [](double error, double sigma) { return error * error / (sigma * sigma); };
    if (o.has_heading) heading.add(squared(axis_difference(o.heading, car.heading), o.sigma_heading));
    if (o.has_length) length.add(squared(o.length - car.length, o.sigma_length));
    if (o.has_width) width.add(squared(o.width - car.width, o.sigma_width));
  }
};

constexpr std::array<std::array<double, 2>, 3> kSizes = {{{3.6, 1.6}, {4.4, 1.8}, {5.0, 1.9}}};

// Small and large cars, all aspects, near and far. A consistent covariance gives a mean of 1 in each class and to
// each value; single errors are neither Gaussian nor independent of the aspect, so this checks a band.
TEST(RectangleFit, ItsErrorsAreThoseItStatesFromEveryAspect) {
  constexpr int kAspects = 36, kCars = 20;
  constexpr double kMost = 3.0;  // one aspect and range, over its degrees of freedom
  RandomStream drawn({17, 0, Purpose::kTest, 0, 0});
  std::array<Consistency, 5> classes;
  std::uint32_t sequence = 0;
  for (const double range : {10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0})
    for (int aspect = 0; aspect < kAspects; ++aspect) {
      Mean cell;
      for (int k = 0; k < kCars; ++k) {
        const double azimuth = drawn.uniform(-0.7, 0.7);  // whole in the field
        const double heading = azimuth + 2.0 * std::numbers::pi * (aspect + drawn.uniform(-0.5, 0.5)) / kAspects;
        const auto& [length, width] = kSizes[drawn.integer(0, 2)];
        const auto car = car_at(range * std::cos(azimuth), range * std::sin(azimuth), heading, length, width);
        const LaserObject o = fitted(car, ++sequence);
        expect_positive_definite(o);
        EXPECT_EQ(o.has_heading, o.seen != SeenPoint::kSilhouette);
        EXPECT_TRUE(o.seen != SeenPoint::kEnd || (o.has_width && !o.has_length));
        EXPECT_TRUE(o.seen != SeenPoint::kSide || (o.has_length && !o.has_width));
        classes[static_cast<std::size_t>(o.seen)].add(o, car);
        const Point truth = truth_of(car, o.seen);
        cell.add(0.5 * squared_distance(o, o.x - truth.x, o.y - truth.y));
      }
      EXPECT_LT(cell.mean(), kMost) << "at " << range << " m, aspect " << aspect * 360 / kAspects << " degrees";
    }
  for (const SeenPoint seen : {SeenPoint::kEnd, SeenPoint::kSide, SeenPoint::kCorner}) {
    const Consistency& of = classes[static_cast<std::size_t>(seen)];
    ASSERT_GT(of.point.count, 100) << static_cast<int>(seen);
    for (const Mean* mean : {&of.point, &of.heading, &of.length, &of.width}) {
      if (mean->count == 0) continue;
      EXPECT_GT(mean->mean(), 0.8) << static_cast<int>(seen);
      EXPECT_LT(mean->mean(), 1.25) << static_cast<int>(seen);
    }
  }
  EXPECT_LT(classes[static_cast<std::size_t>(SeenPoint::kSilhouette)].point.count, 0.005 * sequence);
}

// Counts ends and sides, and those of them whose axis is off by more than 0.5 rad: one of the two taken for the other.
struct Axes {
  int stated = 0, wrong = 0;
  void add(const LaserObject& o, double heading) {
    if (o.seen != SeenPoint::kEnd && o.seen != SeenPoint::kSide) return;
    ++stated;
    wrong += std::abs(axis_difference(o.heading, heading)) > 0.5;
  }
};

// A truck's rear of 2.5 m is a little narrower than the widest one, and looks longer by up to a beam's step. Neither it nor a
// car's or van's face is stated with the wrong axis.
TEST(RectangleFit, AFaceOfAnyWidthToTheWidestIsStatedWithItsAxisOrNone) {
  constexpr int kAspects = 36, kScans = 6;
  LaserPreprocessingConfig preprocessing;
  preprocessing.longest_extent_m = 20.0;  // a truck aslant is no wall
  RandomStream drawn({20, 0, Purpose::kTest, 0, 0});
  std::uint32_t sequence = 0;
  for (const auto& size : {std::array{4.39, 1.79}, {12.0, 2.5}, {5.5, 2.0}}) {
    const double length = size[0], width = size[1];
    Axes from_anywhere;
    for (const double range : {10.0, 20.0, 30.0, 40.0, 46.0, 50.0, 60.0, 70.0, 80.0}) {
      Axes from_behind;
      const auto see = [&](double aspect, Axes& axes) {
        const double azimuth = drawn.uniform(-0.4, 0.4), heading = azimuth + aspect;
        const auto object = car_at(range * std::cos(azimuth), range * std::sin(azimuth), heading, length, width);
        axes.add(fitted(object, ++sequence, {}, preprocessing), heading);
      };
      for (int k = 0; k < kAspects * kScans; ++k) see(std::numbers::pi * (k / kScans) / kAspects, from_anywhere);
      for (int k = 0; k < 40; ++k) see(0.0, from_behind);
      EXPECT_EQ(from_behind.wrong, 0) << "of " << from_behind.stated << ", " << width << " m wide at " << range << " m";
    }
    EXPECT_GT(from_anywhere.stated, 200) << width;
    EXPECT_LT(from_anywhere.wrong, 0.01 * from_anywhere.stated) << width;
  }
}

// A rear seen alone is taken for a corner less often than one scan in a hundred.
TEST(RectangleFit, ARearSeenAloneIsSeldomTakenForACorner) {
  constexpr int kScans = 300;
  RandomStream drawn({18, 0, Purpose::kTest, 0, 0});
  std::uint32_t sequence = 0;
  for (const double range : {20.0, 30.0, 40.0, 50.0}) {
    int corners = 0;
    for (int k = 0; k < kScans; ++k) {
      const double azimuth = drawn.uniform(-0.4, 0.4);
      const auto car = car_at(range * std::cos(azimuth), range * std::sin(azimuth), azimuth);
      corners += fitted(car, ++sequence).seen == SeenPoint::kCorner;
    }
    EXPECT_LT(corners, 0.01 * kScans) << range;
  }
}

// A long side with a short piece of the rear: a corner, or a side with an honest noise.
TEST(RectangleFit, AShortRearBesideALongSideLeavesItACornerOrASide) {
  RandomStream drawn({19, 0, Purpose::kTest, 0, 0});
  std::uint32_t sequence = 0;
  for (const double range : {12.0, 25.0, 40.0}) {
    Mean point;
    int corners = 0;
    for (int k = 0; k < 300; ++k) {
      const double azimuth = drawn.uniform(-0.4, 0.4), aspect = drawn.uniform(0.25, 0.45) * std::numbers::pi;
      const auto car = car_at(range * std::cos(azimuth), range * std::sin(azimuth), azimuth + aspect, 5.0, 1.6);
      const LaserObject o = fitted(car, ++sequence);
      ASSERT_TRUE(o.seen == SeenPoint::kCorner || o.seen == SeenPoint::kSide) << range << " m, " << aspect;
      corners += o.seen == SeenPoint::kCorner;
      const Point truth = truth_of(car, o.seen);
      point.add(0.5 * squared_distance(o, o.x - truth.x, o.y - truth.y));
    }
    EXPECT_GT(corners, 250) << range;
    EXPECT_LT(point.mean(), 1.25) << range;
    EXPECT_GT(point.mean(), 0.8) << range;
  }
}

// The field's edge cuts a car, at either side. The visible part ends at a true corner.
TEST(RectangleFit, TheFreeEndOfACutOutlineIsACorner) {
  double sum = 0.0;
  int ends = 0;
  LaserPreprocessingConfig config;
  for (const double range : {10.0, 25.0, 40.0})
    for (const double turned : {0.0, 0.03, -0.2, 1.2, std::numbers::pi / 2})
      for (const double side : {-1.0, 1.0})
        for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
          const double edge = side * config.half_field_rad, heading = edge + turned;
          const auto far = car_at(range * std::cos(edge), range * std::sin(edge), heading);
          LaserPreprocessor preprocessor(config, kMostPoints);
          std::vector<LaserObject> objects;
          preprocessor.process(emulated_scan({}, {far}, sequence), objects);
          for (const LaserObject& o : objects) {
            if (!is_outermost(o.seen)) continue;
            EXPECT_EQ(o.seen, side > 0.0 ? SeenPoint::kRightmost : SeenPoint::kLeftmost);
            expect_positive_definite(o);
            double nearest = 1e9, squared = 0.0;
            for (const double a : {-0.5, 0.5})
              for (const double b : {-0.5, 0.5}) {
                const double c = std::cos(heading), s = std::sin(heading);
                const double ex = o.x - (far.x + a * far.length * c - b * far.width * s);
                const double ey = o.y - (far.y + a * far.length * s + b * far.width * c);
                if (std::hypot(ex, ey) >= nearest) continue;
                nearest = std::hypot(ex, ey);
                squared = squared_distance(o, ex, ey);
              }
            EXPECT_LT(nearest, 0.05 + 0.01 * range) << range << " " << heading;
            sum += squared;
            ++ends;
          }
        }
  ASSERT_GT(ends, 300);
  EXPECT_NEAR(sum / ends, 2.0, 0.6);
}

}  // namespace
}  // namespace ttf::sensors::laser
