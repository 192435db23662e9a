// The search over lanes against one angle after the other: bitwise the same angle.
#include "nodes/laser/orientation_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "nodes/laser/segmentation.h"
#include "tests/nodes/laser/emulated_scan.h"

namespace ttf::nodes::laser {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kClosest = 0.06;

// Projections of the returns on one axis: their nearest end, and whether the sensor stands outside them.
struct Seen {
  double cos, sin, near;
  bool visible;
  double distance(const PlanePoint& p) const { return std::abs(cos * p.x + sin * p.y - near); }
};

Seen seen_along(double angle, const std::vector<PlanePoint>& points) {
  const double c = std::cos(angle), s = std::sin(angle);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PlanePoint& p : points) {
    low = std::min(low, c * p.x + s * p.y);
    high = std::max(high, c * p.x + s * p.y);
  }
  return {c, s, low + high >= 0.0 ? low : high, low > 0.0 || high < 0.0};
}

double plain_score(double angle, const std::vector<PlanePoint>& points) {
  const Seen a = seen_along(angle, points), b = seen_along(angle + 0.5 * kPi, points);
  double sum = 0.0;
  for (const PlanePoint& p : points) {
    const double da = a.distance(p), db = b.distance(p);
    sum += 1.0 / std::max(a.visible && b.visible ? std::min(da, db) : a.visible ? da : db, kClosest);
  }
  return sum;
}

double plain_search(const std::vector<PlanePoint>& points) {
  constexpr double kCoarse = kPi / 90.0;
  double best = 0.0, best_score = -1.0;
  const auto consider = [&](double angle) {
    const double score = plain_score(angle, points);
    if (score <= best_score) return;
    best_score = score;
    best = angle;
  };
  for (int i = 0; i < 45; ++i) consider(i * kCoarse);
  const double centre = best;
  for (int i = -9; i <= 9; ++i) consider(centre + i * kCoarse / 9.0);
  return best;
}

TEST(OrientationSearch, FindsForEmulatedCarsWhatAPlainSearchFinds) {
  RandomStream fleet({23, 0, Purpose::kTest, 0, 0});
  std::vector<PlanePoint> points;
  std::vector<Segment> segments;
  int compared = 0;
  for (std::uint32_t sequence = 0; sequence < 300; ++sequence) {
    const double range = fleet.uniform(8.0, 60.0), azimuth = fleet.uniform(-0.5, 0.5);
    const auto car = car_at(range * std::cos(azimuth), range * std::sin(azimuth), fleet.uniform(-kPi, kPi));
    segment_scan({}, emulated_scan({}, {car}, sequence), points, segments);
    if (points.empty()) continue;
    ++compared;
    ASSERT_EQ(search_orientation(points, kClosest), plain_search(points)) << sequence;
  }
  EXPECT_GT(compared, 250);
}

// Around the sensor, too, where no face may be in view, and in all quadrants.
TEST(OrientationSearch, FindsForAnyReturnsWhatAPlainSearchFinds) {
  RandomStream drawn({23, 0, Purpose::kTest, 1, 0});
  int hidden = 0, single = 0, both = 0;
  for (int run = 0; run < 1000; ++run) {
    const double x = drawn.uniform(-6.0, 6.0), y = drawn.uniform(-6.0, 6.0), spread = drawn.uniform(0.1, 5.0);
    std::vector<PlanePoint> points(static_cast<std::size_t>(drawn.integer(1, 40)));
    for (PlanePoint& p : points) p = {x + drawn.uniform(-spread, spread), y + drawn.uniform(-spread, spread), 0.0, 0.0};
    const double best = plain_search(points);
    ASSERT_EQ(search_orientation(points, kClosest), best) << run;
    const int faces = seen_along(best, points).visible + seen_along(best + 0.5 * kPi, points).visible;
    ++(faces == 0 ? hidden : faces == 1 ? single : both);
  }
  EXPECT_GT(std::min({hidden, single, both}), 50);
}

// The first of several equal scores counts: a single return lies on both faces at any angle.
TEST(OrientationSearch, TakesTheFirstOfEqualAngles) {
  EXPECT_EQ(search_orientation(std::vector<PlanePoint>{{20.0, 5.0, 0.0, 0.0}}, kClosest), 0.0);
}

}  // namespace
}  // namespace ttf::nodes::laser
