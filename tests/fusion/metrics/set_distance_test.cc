// GOSPA and OSPA against their definitions over all permutations, a metric's axioms, and published values.
#include "fusion/metrics/set_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/random.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::metrics {
namespace {

using Points = std::vector<Point>;

SetDistance compare(const Points& truths, const Points& estimates, const CutOff& cut_off) {
  SetMetric metric(cut_off);
  return metric.between(truths, estimates);
}

// Points on the x axis.
Points on_axis(std::initializer_list<double> xs) {
  Points points;
  for (const double x : xs) points.push_back({x, 0.0});
  return points;
}

// Some of them in one place.
Points drawn_points(RandomStream& stream, std::int64_t most) {
  Points points(static_cast<std::size_t>(stream.integer(0, most)));
  for (Point& p : points) p = {stream.uniform(0, 10), stream.uniform(0, 10)};
  if (points.size() > 2 && stream.uniform() < 0.3) points[0] = points[1];
  return points;
}

CutOff drawn_cut_off(RandomStream& stream) {
  constexpr double kOrders[] = {1.0, 2.0, 3.5};
  return {stream.uniform(0.5, 12.0), kOrders[stream.integer(0, 2)]};
}

// The least sum over all permutations of the larger set (GOSPA paper, definition 1; OSPA paper).
double least_sum(Points fewer, Points more, const CutOff& cut_off) {
  if (fewer.size() > more.size()) std::swap(fewer, more);
  std::vector<std::size_t> order(more.size());
  std::iota(order.begin(), order.end(), 0u);
  double least = std::numeric_limits<double>::infinity();
  do {
    double sum = 0.0;
    for (std::size_t i = 0; i < fewer.size(); ++i)
      sum += std::pow(std::min(cut_off.distance_m, distance_m(fewer[i], more[order[i]])), cut_off.order);
    least = std::min(least, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(SetMetric, IsItsDefinitionOverAllPermutations) {
  for (std::uint32_t index = 0; index < 600; ++index) {
    RandomStream stream({.seed = 31, .purpose = Purpose::kTest, .index = index});
    const CutOff cut_off = drawn_cut_off(stream);
    const Points x = drawn_points(stream, 6), y = drawn_points(stream, 6);
    const SetDistance d = compare(x, y, cut_off);
    const double least = least_sum(x, y, cut_off), whole = std::pow(cut_off.distance_m, cut_off.order);
    const auto more = static_cast<double>(std::max(x.size(), y.size()));
    const double apart = more - static_cast<double>(std::min(x.size(), y.size()));
    const double gospa = std::pow(least + 0.5 * whole * apart, 1.0 / cut_off.order);
    const double ospa = more == 0.0 ? 0.0 : std::pow((least + whole * apart) / more, 1.0 / cut_off.order);
    ASSERT_NEAR(d.gospa.distance_m, gospa, 1e-10 * (1.0 + gospa)) << index;
    ASSERT_NEAR(d.ospa.distance_m, ospa, 1e-10 * (1.0 + ospa)) << index;
    ASSERT_LE(d.ospa.distance_m, cut_off.distance_m * (1.0 + 1e-12)) << index;
  }
}

TEST(SetMetric, IdentityAndSymmetry) {
  for (std::uint32_t index = 0; index < 600; ++index) {
    RandomStream stream({.seed = 32, .purpose = Purpose::kTest, .index = index});
    const CutOff cut_off = drawn_cut_off(stream);
    const Points x = drawn_points(stream, 6), y = drawn_points(stream, 6);
    Points again(x.rbegin(), x.rend());  // a set has no order
    const SetDistance self = compare(x, again, cut_off);
    ASSERT_EQ(self.gospa.distance_m, 0.0);
    ASSERT_EQ(self.ospa.distance_m, 0.0);
    ASSERT_EQ(self.pairs, x.size());

    const SetDistance d = compare(x, y, cut_off), back = compare(y, x, cut_off);
    ASSERT_NEAR(d.gospa.distance_m, back.gospa.distance_m, 1e-12 * (1.0 + d.gospa.distance_m));
    ASSERT_NEAR(d.ospa.distance_m, back.ospa.distance_m, 1e-12 * (1.0 + d.ospa.distance_m));
    ASSERT_EQ(d.pairs, back.pairs);
    ASSERT_EQ(d.gospa.missed, back.gospa.false_estimates);
    ASSERT_EQ(d.gospa.false_estimates, back.gospa.missed);
    if (x.size() != y.size()) {
      ASSERT_GT(d.gospa.distance_m, 0.0);
      ASSERT_GT(d.ospa.distance_m, 0.0);
    }
  }
}

TEST(SetMetric, TriangleInequality) {
  int close = 0;
  for (std::uint32_t index = 0; index < 4000; ++index) {
    RandomStream stream({.seed = 33, .purpose = Purpose::kTest, .index = index});
    const CutOff cut_off = drawn_cut_off(stream);
    const Points x = drawn_points(stream, 4), y = drawn_points(stream, 4), z = drawn_points(stream, 4);
    const SetDistance xy = compare(x, y, cut_off), yz = compare(y, z, cut_off), xz = compare(x, z, cut_off);
    const double gospa = xy.gospa.distance_m + yz.gospa.distance_m, ospa = xy.ospa.distance_m + yz.ospa.distance_m;
    ASSERT_LE(xz.gospa.distance_m, gospa * (1.0 + 1e-10)) << index;
    ASSERT_LE(xz.ospa.distance_m, ospa * (1.0 + 1e-10)) << index;
    close += xz.gospa.distance_m > 0.9 * gospa;
  }
  EXPECT_GT(close, 50) << "no draw comes near the bound";
}

TEST(SetMetric, PartsAddUp) {
  for (std::uint32_t index = 0; index < 300; ++index) {
    RandomStream stream({.seed = 34, .purpose = Purpose::kTest, .index = index});
    const CutOff cut_off = drawn_cut_off(stream);
    const SetDistance d = compare(drawn_points(stream, 6), drawn_points(stream, 6), cut_off);
    const double gospa = std::pow(d.gospa.distance_m, cut_off.order), ospa = std::pow(d.ospa.distance_m, cut_off.order);
    const Gospa& g = d.gospa;
    ASSERT_NEAR(g.localisation + g.missed + g.false_estimates, gospa, 1e-11 * (1.0 + gospa));
    ASSERT_NEAR(d.ospa.localisation + d.ospa.cardinality, ospa, 1e-11 * (1.0 + ospa));
  }
}

//   truth     0        10        20
//   estimate  0.3           14        40     c = 3, p = 2: one pair, two missed, two false
TEST(SetMetric, PartsByHand) {
  const SetDistance d = compare(on_axis({0, 10, 20}), on_axis({0.3, 14, 40}), {3.0, 2.0});
  EXPECT_EQ(d.pairs, 1u);
  EXPECT_NEAR(d.gospa.localisation, 0.09, 1e-15);
  EXPECT_DOUBLE_EQ(d.gospa.missed, 9.0);  // 2 * 9 / 2
  EXPECT_DOUBLE_EQ(d.gospa.false_estimates, 9.0);
  EXPECT_NEAR(d.gospa.distance_m, std::sqrt(18.09), 1e-14);
  EXPECT_NEAR(d.ospa.localisation, 18.09 / 3.0, 1e-14);
  EXPECT_EQ(d.ospa.cardinality, 0.0);
}

TEST(SetMetric, EmptySets) {
  const CutOff cut_off{4.0, 2.0};
  EXPECT_EQ(compare({}, {}, cut_off).gospa.distance_m, 0.0);
  EXPECT_EQ(compare({}, {}, cut_off).ospa.distance_m, 0.0);
  const SetDistance missed = compare(on_axis({1, 2, 3}), {}, cut_off),
                    false_ones = compare({}, on_axis({1, 2}), cut_off);
  EXPECT_DOUBLE_EQ(missed.gospa.missed, 24.0);  // 3 * 16 / 2
  EXPECT_EQ(missed.gospa.false_estimates, 0.0);
  EXPECT_DOUBLE_EQ(missed.ospa.distance_m, 4.0);
  EXPECT_DOUBLE_EQ(false_ones.gospa.false_estimates, 16.0);
  EXPECT_DOUBLE_EQ(false_ones.gospa.distance_m, 4.0);
  EXPECT_DOUBLE_EQ(false_ones.ospa.distance_m, 4.0);
}

// At the cut-off a pair costs as much as a miss and a false estimate. The distance is continuous there, while
// its parts change.
TEST(SetMetric, AtTheCutOff) {
  const CutOff cut_off{2.0, 2.0};
  const double inside = std::nextafter(2.0, 0.0);
  const SetDistance near = compare(on_axis({0}), on_axis({inside}), cut_off),
                    far = compare(on_axis({0}), on_axis({2.0}), cut_off);
  EXPECT_EQ(near.pairs, 1u);
  EXPECT_EQ(near.gospa.missed, 0.0);
  EXPECT_EQ(far.pairs, 0u);
  EXPECT_EQ(far.gospa.localisation, 0.0);
  EXPECT_DOUBLE_EQ(far.gospa.missed, 2.0);
  EXPECT_DOUBLE_EQ(near.gospa.distance_m, far.gospa.distance_m);
  EXPECT_DOUBLE_EQ(near.ospa.distance_m, 2.0);
  EXPECT_DOUBLE_EQ(compare(on_axis({0}), on_axis({1e9}), cut_off).gospa.distance_m, 2.0) << "further does not count";
}

//   truth       0     1         nearest first: 1-1 and nothing for 0, as 2.2 is beyond the cut-off: 0 + 4
//   estimate          1   2.2   best: 1 + 1.44
TEST(SetMetric, NearestFirstWouldBeWorse) {
  const SetDistance d = compare(on_axis({0, 1}), on_axis({1, 2.2}), {2.0, 2.0});
  EXPECT_EQ(d.pairs, 2u);
  EXPECT_NEAR(d.gospa.localisation, 2.44, 1e-14);
}

TEST(SetMetric, APlaceThatIsNotFiniteIsFarAway) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const SetDistance d = compare(on_axis({0, 5}), {{0.0, 0.0}, {nan, 5.0}, {inf, 0.0}}, {3.0, 1.0});
  EXPECT_EQ(d.pairs, 1u);
  EXPECT_DOUBLE_EQ(d.gospa.missed, 1.5);
  EXPECT_DOUBLE_EQ(d.gospa.false_estimates, 3.0);
  EXPECT_DOUBLE_EQ(d.gospa.distance_m, 4.5);
}

// Stone Soup, stonesoup/metricgenerator/tests/test_ospametric.py: test_ospametric_computemetric,
// test_ospa_computemetric_cardinality_error (c = 10).
TEST(PublishedValues, StoneSoupOspa) {
  const Points truths = on_axis({0, 1, 2, 3, 4});
  const struct {
    Points estimates;
    double order, value;
  } rows[] = {{on_axis({0.5, 1.5, 2.5, 3.5, 4.5}), 1.0, 0.5}, {on_axis({0.2, 1.2, 2.2, 3.2, 4.2}), 1.0, 0.2},
              {on_axis({0.5, 1.5, 2.5, 3.5, 4.5}), 2.0, 0.5}, {on_axis({0.2, 1.2, 2.2, 3.2, 4.2}), 2.0, 0.2},
              {on_axis({0.5, 1.5, 2.5, 3.5}), 1.0, 2.4},      {on_axis({0.2, 1.2, 2.2, 3.2}), 1.0, 2.16},
              {on_axis({0.5, 1.5, 2.5, 3.5}), 2.0, 4.49444},  {on_axis({0.2, 1.2, 2.2, 3.2}), 2.0, 4.47571}};
  for (const auto& row : rows)
    EXPECT_NEAR(compare(truths, row.estimates, {10.0, row.order}).ospa.distance_m, row.value, 5e-6) << row.order;
}

// The same file: test_gospametric_computemetric (c = 10, p = 1). Also the second instant of
// test_switching_gospametric_computemetric (c = 2, p = 2), without its switching term.
TEST(PublishedValues, StoneSoupGospa) {
  const Points truths = on_axis({0, 1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(compare(truths, on_axis({0.5, 1.5, 2.5, 3.5, 4.5}), {10.0, 1.0}).gospa.distance_m / 5.0, 0.5);
  EXPECT_DOUBLE_EQ(compare(truths, on_axis({1, 2, 3, 4, 5}), {10.0, 1.0}).gospa.distance_m / 5.0, 1.0);
  const SetDistance d = compare(on_axis({1, 2, 3}), on_axis({2, 1, 100}), {2.0, 2.0});
  EXPECT_EQ(d.gospa.localisation, 0.0);
  EXPECT_DOUBLE_EQ(d.gospa.missed, 2.0);
  EXPECT_DOUBLE_EQ(d.gospa.false_estimates, 2.0);
  EXPECT_DOUBLE_EQ(d.gospa.distance_m, 2.0);
}

// The GOSPA paper's example of two objects and their estimates, c = 8, from ewilthil/gospapy
// (examples/replicate_table_fusion2017.py). The false estimates are read off the paper's figure. Means
// replace the paper's noise, so the values are by hand.
TEST(PublishedValues, ExampleOfTheGospaPaperWithoutNoise) {
  const Points truths{{-6, -6}, {0, 3}}, good{{-6.7, -5.1}, {-1.8, 2.9}};
  const Points false_ones{{22, 18}, {-10, 18},  {35, 42}, {38, 0},  {50, 35},
                          {7, 28},  {-15, -19}, {17, 17}, {42, 30}, {20, 15}};
  EXPECT_NEAR(compare(truths, good, {8.0, 1.0}).gospa.distance_m, std::sqrt(1.3) + std::sqrt(3.25), 1e-14);
  EXPECT_NEAR(compare(truths, good, {8.0, 2.0}).gospa.distance_m, std::sqrt(4.55), 1e-14);
  for (const std::size_t missed : {0u, 1u, 2u})
    for (const std::size_t n : {0u, 1u, 3u, 10u}) {
      Points estimates(good.begin(), good.end() - static_cast<std::ptrdiff_t>(missed));
      estimates.insert(estimates.end(), false_ones.begin(), false_ones.begin() + static_cast<std::ptrdiff_t>(n));
      const double localisation = missed == 0 ? 4.55 : missed == 1 ? 1.3 : 0.0;
      const SetDistance d = compare(truths, estimates, {8.0, 2.0});
      EXPECT_NEAR(d.gospa.localisation, localisation, 1e-13);
      EXPECT_DOUBLE_EQ(d.gospa.missed, 32.0 * static_cast<double>(missed));
      EXPECT_DOUBLE_EQ(d.gospa.false_estimates, 32.0 * static_cast<double>(n));
    }
}

TEST(SetMetric, ThousandObjectsWithoutAllocationTheSecondTime) {
  constexpr std::size_t kN = 1000;
  Points truths(kN), estimates(kN);
  RandomStream stream({.seed = 35, .purpose = Purpose::kTest});
  for (std::size_t i = 0; i < kN; ++i) {
    truths[i] = {10.0 * static_cast<double>(i % 40), 10.0 * static_cast<double>(i / 40)};
    estimates[kN - 1 - i] = {truths[i].x + stream.uniform(-1, 1), truths[i].y + stream.uniform(-1, 1)};
  }
  SetMetric metric({5.0, 2.0});
  metric.between(truths, estimates);
  const std::int64_t before = support::allocations();
  const SetDistance d = metric.between(truths, estimates);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_EQ(d.pairs, kN);
  for (std::size_t i = 0; i < kN; ++i) ASSERT_EQ(metric.estimate_of()[i], static_cast<int>(kN - 1 - i));
}

}  // namespace
}  // namespace ttf::fusion::metrics
