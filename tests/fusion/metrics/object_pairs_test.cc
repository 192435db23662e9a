// Least-cost pairs of objects, by hand and against all ways to pair.
#include "fusion/metrics/object_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/random.h"

namespace ttf::fusion::metrics {
namespace {

using Points = std::vector<Point>;

Points drawn_places(RandomStream& draw, std::int64_t least, std::int64_t most, double extent) {
  Points points(static_cast<std::size_t>(draw.integer(least, most)));
  for (Point& p : points) p = {draw.uniform(0, extent), draw.uniform(0, extent)};
  return points;
}

// The cost that the pairs leave: d^2 of each, and half of the gate's square for everything left apart.
double cost_left(const Points& truths, const Points& estimates, const std::vector<ObjectPair>& pairs, double gate) {
  double sum = 0.5 * gate * gate * static_cast<double>(truths.size() + estimates.size() - 2 * pairs.size());
  for (const ObjectPair& pair : pairs) sum += std::pow(distance_m(truths[pair.truth], estimates[pair.estimate]), 2);
  return sum;
}

// Tries each free estimate within the gate, or none, for every truth in turn.
double least_of_all(const Points& truths, const Points& estimates, double gate, std::size_t truth = 0,
                    unsigned taken = 0) {
  const double half = 0.5 * gate * gate;
  if (truth == truths.size()) {
    double free = 0.0;
    for (std::size_t e = 0; e < estimates.size(); ++e) free += (taken >> e & 1u) != 0 ? 0.0 : half;
    return free;
  }
  double least = half + least_of_all(truths, estimates, gate, truth + 1, taken);
  for (std::size_t e = 0; e < estimates.size(); ++e)
    if (const double d = distance_m(truths[truth], estimates[e]); d <= gate && (taken >> e & 1u) == 0)
      least = std::min(least, d * d + least_of_all(truths, estimates, gate, truth + 1, taken | 1u << e));
  return least;
}

//   truth      0           1.4
//   estimate -0.9      1.0         both ways give two pairs: 0.81 + 0.16, or 1 + 5.29
TEST(ObjectPairs, StandByGrowingDistance) {
  const Points truths{{0, 0}, {1.4, 0}}, estimates{{-0.9, 0}, {1.0, 0}};
  const auto pairs = object_pairs(truths, estimates, 4.0);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].truth, 1u);
  EXPECT_EQ(pairs[0].estimate, 1u);
  EXPECT_EQ(pairs[1].truth, 0u);
  EXPECT_EQ(pairs[1].estimate, 0u);
}

//   truth     0     2         the closest pair first: (2, 1.2), and 0 has no partner within 2
//   estimate     1.2    3.4   least cost: (0, 1.2) and (2, 3.4), 1.44 + 1.96, below 0.64 + 4
TEST(ObjectPairs, TheClosestPairMayServeOthers) {
  const Points truths{{0, 0}, {2, 0}}, estimates{{1.2, 0}, {3.4, 0}};
  const auto pairs = object_pairs(truths, estimates, 2.0);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].truth, 0u);
  EXPECT_EQ(pairs[0].estimate, 0u);
  EXPECT_EQ(pairs[1].truth, 1u);
  EXPECT_EQ(pairs[1].estimate, 1u);
}

TEST(ObjectPairs, OneEstimateServesOneTruthOnly) {
  const Points truths{{0, 0}, {0.2, 0}}, estimates{{0.1, 0}};
  const auto pairs = object_pairs(truths, estimates, 1.0);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].truth, 0u) << "equally far: the order of truth decides";
}

TEST(ObjectPairs, NothingBeyondTheGate) {
  const Points truths{{0, 0}};
  EXPECT_EQ(object_pairs(truths, Points{{0, 1.5}}, 1.5).size(), 1u);
  EXPECT_TRUE(object_pairs(truths, Points{{0, 1.5001}}, 1.5).empty());
  EXPECT_TRUE(object_pairs(truths, {}, 1.5).empty());
  EXPECT_TRUE(object_pairs({}, truths, 1.5).empty());
}

// They are one to one, within the gate, and cost the least.
TEST(ObjectPairs, AreAsGoodAsTryingAllWays) {
  std::size_t all = 0;
  for (std::uint32_t scene = 0; scene < 400; ++scene) {
    RandomStream draw({.seed = 7, .purpose = Purpose::kTest, .index = scene});
    const Points truths = drawn_places(draw, 0, 7, 6.0), estimates = drawn_places(draw, 0, 7, 6.0);
    const auto pairs = object_pairs(truths, estimates, 2.0);
    std::set<std::size_t> truth, estimate;
    double last = 0.0;
    for (const ObjectPair& pair : pairs) {
      const double now = distance_m(truths[pair.truth], estimates[pair.estimate]);
      EXPECT_GE(now, last);
      EXPECT_LE(now, 2.0);
      last = now;
      EXPECT_TRUE(truth.insert(pair.truth).second);
      EXPECT_TRUE(estimate.insert(pair.estimate).second);
    }
    all += pairs.size();
    ASSERT_NEAR(cost_left(truths, estimates, pairs, 2.0), least_of_all(truths, estimates, 2.0), 1e-10) << scene;
  }
  EXPECT_GT(all, 600u);
}

// The closest of all pairs that are left, again and again.
std::vector<ObjectPair> closest_first(const Points& truths, const Points& estimates, double gate) {
  std::vector<ObjectPair> pairs;
  std::set<std::size_t> truth, estimate;
  while (true) {
    double least = std::numeric_limits<double>::infinity();
    ObjectPair closest;
    for (std::size_t t = 0; t < truths.size(); ++t)
      for (std::size_t e = 0; e < estimates.size(); ++e)
        if (const double apart = distance_m(truths[t], estimates[e]);
            apart <= gate && apart < least && !truth.contains(t) && !estimate.contains(e)) {
          least = apart;
          closest = {t, e};
        }
    if (std::isinf(least)) return pairs;
    truth.insert(closest.truth);
    estimate.insert(closest.estimate);
    pairs.push_back(closest);
  }
}

// Positions are drawn, on a grid, far away, or no numbers.
TEST(ObjectPairs, OfManyAreNeverWorseThanTheClosestPairFirst) {
  int better = 0;
  for (std::uint32_t scene = 0; scene < 60; ++scene) {
    RandomStream draw({.seed = 7, .purpose = Purpose::kTest, .entity = 1, .index = scene});
    const double gate = scene % 4 == 0 ? 1.0 : draw.uniform(0.2, 3.0);
    const double off = scene % 5 == 0 ? 1e15 : scene % 5 == 1 ? -3e7 : 0.0;
    const auto place = [&] {
      const double at = draw.uniform(-12.0, 12.0);
      return off + (scene % 3 == 0 ? std::round(at * 2.0) / 2.0 : at);
    };
    Points truths(static_cast<std::size_t>(draw.integer(20, 60))),
        estimates(static_cast<std::size_t>(draw.integer(55, 90)));
    for (auto* list : {&truths, &estimates})
      for (Point& position : *list) position = {place(), place()};
    truths[3].x = estimates[5].y = std::nan("");
    truths[4].y = estimates[6].x = std::numeric_limits<double>::infinity();
    truths[5] = estimates[7] = {std::numeric_limits<double>::max(), -std::numeric_limits<double>::max()};
    const auto pairs = object_pairs(truths, estimates, gate), greedy = closest_first(truths, estimates, gate);
    const double cost = cost_left(truths, estimates, pairs, gate), bound = cost_left(truths, estimates, greedy, gate);
    ASSERT_LE(cost, bound * (1.0 + 1e-12)) << scene;
    better += cost < bound * (1.0 - 1e-9);
    for (const ObjectPair& pair : pairs) {
      ASSERT_TRUE(pair.truth != 3 && pair.truth != 4 && pair.estimate != 5 && pair.estimate != 6) << scene;
      ASSERT_TRUE((pair.truth == 5) == (pair.estimate == 7)) << scene;
    }
  }
  EXPECT_GT(better, 10) << "the scenes hold no conflict";
}

// A thousand separated objects in drawn order: each finds its own estimate.
TEST(ObjectPairs, OfAThousandSeparatedObjectsAreTheirOwn) {
  constexpr std::size_t kN = 1000;
  RandomStream draw({.seed = 8, .purpose = Purpose::kTest});
  Points truths(kN), estimates(kN);
  for (std::size_t i = 0; i < kN; ++i) {
    truths[i] = {10.0 * static_cast<double>(i % 40), 10.0 * static_cast<double>(i / 40)};
    estimates[kN - 1 - i] = {truths[i].x + draw.uniform(-1, 1), truths[i].y + draw.uniform(-1, 1)};
  }
  const auto pairs = object_pairs(truths, estimates, 4.0);
  ASSERT_EQ(pairs.size(), kN);
  for (const ObjectPair& pair : pairs) ASSERT_EQ(pair.estimate, kN - 1 - pair.truth);
}

}  // namespace
}  // namespace ttf::fusion::metrics
