// Expected errors of sequences: closed forms, and the choice of a bound.
#include "schedules/sequence/expected_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/schedules/durations.h"

namespace ttf::schedules::sequence {
namespace {

// The steady alpha-beta filter (Bar-Shalom et al., 2001, 6.5.3): beta^2 / (1 - alpha) = q T^3 / R and
// alpha = sqrt(2 beta + beta^2 / 12) - beta / 2. Returns the covariance behind an update.
struct AlphaBeta {
  double position, mixed, velocity;
  AlphaBeta(double q, double r, double t) {
    double low = 0.0, high = 1.6, alpha = 0.0, beta = 0.0;
    for (int i = 0; i < 200; ++i) {
      beta = 0.5 * (low + high);
      alpha = std::sqrt(2.0 * beta + beta * beta / 12.0) - beta / 2.0;
      (beta * beta / (1.0 - alpha) < q * t * t * t / r ? low : high) = beta;
    }
    position = alpha * r;
    mixed = beta * r / t;
    velocity = alpha * beta * r / (t * t * (1.0 - alpha)) - q * t / 2.0;
  }
};

TEST(ExpectedErrorOfSequence, SettlesAtTheAlphaBetaFilterAndItsPredictions) {
  for (const double q : {0.01, 1.0, 25.0})
    for (const double sigma : {0.1, 1.0})
      for (const std::int64_t period : {20, 100, 250}) {
        const double t = 1e-3 * static_cast<double>(period), r = sigma * sigma;
        const AlphaBeta p(q, r, t);
        const auto predicted = [&](double d) {
          return p.position + 2.0 * d * p.mixed + d * d * p.velocity + q * d * d * d / 3.0;
        };
        // One sensor: the result of a detection comes when the next one begins.
        const auto found = expected_errors({{0, false}}, DetectionTimes(1, ms(period), ms(1)), {q, sigma});
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(found[0].worst / predicted(2.0 * t), 1.0, 1e-7);
        double mean = 0.0;  // Simpson's rule is exact for a cubic
        mean = (predicted(t) + 4.0 * predicted(1.5 * t) + predicted(2.0 * t)) / 6.0;
        EXPECT_NEAR(found[0].mean / mean, 1.0, 1e-7);
      }
}

// Two sensors of variance 0.01 m^2 look in turn, each every 40 ms. One sensor every 20 ms is worth the same. Results
// are there at once: the detection takes a nanosecond, and another sensor's the rest.
TEST(ExpectedErrorOfSequence, AgreesWithThePublishedMeans) {
  for (const auto& [q, variance] : {std::pair{0.01, 7.525e-4}, std::pair{1.0, 2.3897e-3}, std::pair{25.0, 5.446e-3}}) {
    DetectionTimes times(2, ms(20), ms(1));
    times.primary = {Duration{1}, ms(20) - Duration{1}};
    const auto found = expected_errors({{0, false}, {1, false}}, times, {q, 0.1});
    EXPECT_NEAR(found[0].mean / variance, 1.0, 1e-3) << q;
  }
}

// The same detections come in another order.
TEST(ExpectedErrorOfSequence, EvenIntervalsAreBetter) {
  const DetectionTimes times(2, ms(50), ms(50));
  const Sequence beside{{0, false}, {0, true}, {1, false}, {1, true}},
      apart{{0, false}, {1, false}, {0, true}, {1, true}};
  const auto uneven = expected_errors(beside, times, {}), even = expected_errors(apart, times, {});
  for (int sensor = 0; sensor < 2; ++sensor) {
    EXPECT_LT(even[sensor].mean, uneven[sensor].mean);
    EXPECT_LT(even[sensor].worst, uneven[sensor].worst);
    EXPECT_NEAR(even[sensor].mean, even[0].mean, 1e-9);
  }
}

// A frame begins anywhere.
TEST(ExpectedErrorOfSequence, DoesNotDependOnTheFramesBeginning) {
  const DetectionTimes times(3, us(46'300), us(27'700));
  const Sequence frame{{0, false}, {0, true}, {1, false}, {0, true}, {2, false}, {0, true}};
  Sequence turned = frame;
  std::rotate(turned.begin(), turned.begin() + 2, turned.end());
  const auto one = expected_errors(frame, times, {}), other = expected_errors(turned, times, {});
  for (std::size_t sensor = 0; sensor < 3; ++sensor) EXPECT_NEAR(one[sensor].mean / other[sensor].mean, 1.0, 1e-8);
}

class Choices : public ::testing::Test {
 protected:
  std::vector<BoundChoice> of(double share, double noise = 1.0, SlotRule slots = SlotRule::kText) const {
    return choices({3, interest, us(138'900), us(27'700), ms(500), slots}, DetectionTimes(3, us(46'300), us(27'700)),
                   {noise, 1.0}, share);
  }
  std::vector<int> interest{0};
};

// One nanosecond less gives the frame before.
TEST_F(Choices, EachBoundIsTheLeastForItsFrame) {
  for (const SlotRule slots : {SlotRule::kText, SlotRule::kFloor}) {
    const auto all = of(0.5, 1.0, slots);
    ASSERT_GT(all.size(), 10u);
    EXPECT_EQ(letters(all[0].sequence), "ABC");
    const auto frame_for = [&](Duration bound) {
      return generated({3, interest, us(138'900), us(27'700), bound, slots});
    };
    for (std::size_t m = 1; m < all.size(); ++m) {
      EXPECT_EQ(all[m].secondaries, static_cast<int>(m));
      const Duration above{slots == SlotRule::kText && m == 1 ? 1 : 0};
      EXPECT_EQ(frame_for(all[m].least_bound + above), all[m].sequence) << m;
      EXPECT_EQ(frame_for(all[m].least_bound + above - Duration{1}), all[m - 1].sequence) << m;
    }
  }
}

// More secondary detections help the object of interest and cost the others. So the best bound grows with the share.
TEST_F(Choices, TheBestBoundGrowsWithTheShareOfInterest) {
  const auto all = of(0.5);
  EXPECT_GT(all[0].interest, all[3].interest);
  EXPECT_LT(all[0].others, all[3].others);
  EXPECT_NEAR(all[0].interest, all[0].others, 1e-9) << "without secondary detections they are alike";
  EXPECT_EQ(best(of(0.0)).secondaries, 0);
  EXPECT_GT(best(of(1.0)).secondaries, 3);
  int before = 0;
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    const int now = best(of(share)).secondaries;
    EXPECT_GE(now, before) << share;
    before = now;
  }
}

TEST_F(Choices, WithoutOthersTheShareIsOne) {
  interest = {0, 1, 2};
  for (const BoundChoice& choice : of(0.2)) {
    EXPECT_EQ(choice.others, 0.0);
    EXPECT_EQ(choice.cost, choice.interest);
  }
}

}  // namespace
}  // namespace ttf::schedules::sequence
