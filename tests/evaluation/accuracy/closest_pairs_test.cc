#include "evaluation/accuracy/closest_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
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

}  // namespace
}  // namespace ttf::evaluation::accuracy
