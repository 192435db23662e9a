#include "evaluation/accuracy/closest_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/random.h"

namespace ttf::evaluation::accuracy {
namespace {

double distance(const PlanePosition& a, const PlanePosition& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(ClosestPairs, TheClosestPairComesFirstAndTakesBoth) {
  // The estimate at 1.0 is nearer to the second truth; the first one is left with the farther estimate.
  const std::vector<PlanePosition> truth{{0, 0}, {1.4, 0}}, estimates{{-0.9, 0}, {1.0, 0}};
  const auto pairs = closest_pairs(truth, estimates, 4.0);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].truth, 1u);
  EXPECT_EQ(pairs[0].estimate, 1u);
  EXPECT_EQ(pairs[1].truth, 0u);
  EXPECT_EQ(pairs[1].estimate, 0u);
}

TEST(ClosestPairs, OneEstimateServesOneTruthOnly) {
  const std::vector<PlanePosition> truth{{0, 0}, {0.2, 0}}, estimates{{0.1, 0}};
  const auto pairs = closest_pairs(truth, estimates, 1.0);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].truth, 0u) << "equally far: the order of truth decides";
}

TEST(ClosestPairs, NothingBeyondTheGate) {
  const std::vector<PlanePosition> truth{{0, 0}};
  EXPECT_EQ(closest_pairs(truth, std::vector<PlanePosition>{{0, 1.5}}, 1.5).size(), 1u);
  EXPECT_TRUE(closest_pairs(truth, std::vector<PlanePosition>{{0, 1.5001}}, 1.5).empty());
  EXPECT_TRUE(closest_pairs(truth, {}, 1.5).empty());
  EXPECT_TRUE(closest_pairs({}, truth, 1.5).empty());
}

// Drawn scenes: each at most once, no pair beyond the gate, growing distances, and no possible pair left.
TEST(ClosestPairs, DrawnScenesAreOneToOneAndComplete) {
  for (std::uint32_t scene = 0; scene < 200; ++scene) {
    RandomStream draw({7, 0, Purpose::kTest, 0, scene});
    std::vector<PlanePosition> truth(static_cast<std::size_t>(draw.integer(0, 12))),
        estimates(static_cast<std::size_t>(draw.integer(0, 12)));
    for (auto* list : {&truth, &estimates})
      for (PlanePosition& position : *list) position = {draw.uniform(0, 10), draw.uniform(0, 10)};
    std::set<std::size_t> truths, taken;
    double last = 0.0;
    for (const TruthPair& pair : closest_pairs(truth, estimates, 2.0)) {
      const double now = distance(truth[pair.truth], estimates[pair.estimate]);
      EXPECT_GE(now, last);
      EXPECT_LE(now, 2.0);
      last = now;
      EXPECT_TRUE(truths.insert(pair.truth).second);
      EXPECT_TRUE(taken.insert(pair.estimate).second);
    }
    for (std::size_t t = 0; t < truth.size(); ++t)
      for (std::size_t e = 0; e < estimates.size(); ++e)
        if (!truths.contains(t) && !taken.contains(e)) {
          EXPECT_GT(distance(truth[t], estimates[e]), 2.0);
        }
  }
}

// The plain way: the closest of all pairs that are left, again and again.
std::vector<TruthPair> one_by_one(const std::vector<PlanePosition>& truth, const std::vector<PlanePosition>& estimates,
                                  double gate) {
  std::vector<TruthPair> pairs;
  std::set<std::size_t> truths, taken;
  while (true) {
    double least = std::numeric_limits<double>::infinity();
    TruthPair closest;
    for (std::size_t t = 0; t < truth.size(); ++t)
      for (std::size_t e = 0; e < estimates.size(); ++e)
        if (const double apart = distance(truth[t], estimates[e]);
            apart <= gate && apart < least && !truths.contains(t) && !taken.contains(e)) {
          least = apart;
          closest = {t, e};
        }
    if (std::isinf(least)) return pairs;
    truths.insert(closest.truth);
    taken.insert(closest.estimate);
    pairs.push_back(closest);
  }
}

// Positions are drawn, on a grid, far away, or no numbers.
TEST(Pairing, OfManyIsThatOfThePlainWay) {
  std::size_t all = 0;
  for (std::uint32_t scene = 0; scene < 60; ++scene) {
    RandomStream draw({7, 0, Purpose::kTest, 1, scene});
    const double gate = scene % 4 == 0 ? 1.0 : draw.uniform(0.2, 3.0);
    const double off = scene % 5 == 0 ? 1e15 : scene % 5 == 1 ? -3e7 : 0.0;
    const auto place = [&] {
      const double at = draw.uniform(-12.0, 12.0);
      return off + (scene % 3 == 0 ? std::round(at * 2.0) / 2.0 : at);
    };
    std::vector<PlanePosition> truth(static_cast<std::size_t>(draw.integer(20, 60))),
        estimates(static_cast<std::size_t>(draw.integer(55, 90)));
    for (auto* list : {&truth, &estimates})
      for (PlanePosition& position : *list) position = {place(), place()};
    truth[3].x = estimates[5].y = std::nan("");
    truth[4].y = estimates[6].x = std::numeric_limits<double>::infinity();
    truth[5] = estimates[7] = {std::numeric_limits<double>::max(), -std::numeric_limits<double>::max()};
    const auto pairs = closest_pairs(truth, estimates, gate), expected = one_by_one(truth, estimates, gate);
    all += pairs.size();
    ASSERT_EQ(pairs.size(), expected.size()) << scene;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      ASSERT_EQ(pairs[i].truth, expected[i].truth) << scene;
      ASSERT_EQ(pairs[i].estimate, expected[i].estimate) << scene;
    }
  }
  EXPECT_GT(all, 900u);
}

}  // namespace
}  // namespace ttf::evaluation::accuracy
