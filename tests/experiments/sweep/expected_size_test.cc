// The expected error of lengths and widths: against closed forms, and against the tracker's extent on drawn sizes.
#include "experiments/sweep/expected_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "fusion/tracks/body/extent.h"

namespace ttf::experiments::sweep {
namespace {

using sim::world::SizeConfig;
using sim::world::SizeDraw;

// Cars as they are drawn by default.
SizeMoments cars() { return moments_of(SizeConfig{.draw = SizeDraw::kNormal}, {}); }

fusion::config::Sizes prior_of(const SizeMoments& moments) {
  const Eigen::Vector2d sigma = moments.covariance.diagonal().cwiseSqrt();
  return {moments.mean(0), sigma(0), moments.mean(1), sigma(1), moments.covariance(0, 1) / (sigma(0) * sigma(1))};
}

TEST(ExpectedSize, MomentsAreThoseOfTheDraw) {
  const SizeMoments normal = cars();
  EXPECT_NEAR(normal.mean(0), 4.65, 1e-4);
  EXPECT_NEAR(normal.mean(1), 1.76, 1e-4);
  EXPECT_NEAR(normal.covariance(0, 0), 0.37 * 0.37, 1e-4);
  EXPECT_NEAR(normal.covariance(1, 1), 0.01, 1e-5);
  EXPECT_NEAR(normal.covariance(0, 1), 0.82 * 0.37 * 0.10, 1e-5);
  const SizeMoments uniform = moments_of(SizeConfig{.draw = SizeDraw::kUniform}, {});
  EXPECT_NEAR(uniform.mean(0), 4.4, 1e-12);
  EXPECT_NEAR(uniform.covariance(0, 0), 1.22 * 1.22 / 12.0, 1e-12);
  EXPECT_EQ(uniform.covariance(0, 1), 0.0);
  const SizeMoments nominal = moments_of(SizeConfig{}, {4.39, 1.79});
  EXPECT_EQ(nominal.mean, Eigen::Vector2d(4.39, 1.79));
  EXPECT_EQ(nominal.covariance, Eigen::Matrix2d(Eigen::Matrix2d::Zero()));
}

// A normal number between -1 and 1 standard deviations has the variance 1 - 2 phi(1) / (2 Phi(1) - 1) = 0.2911.
TEST(ExpectedSize, LimitsCountInTheMoments) {
  SizeConfig config{.draw = SizeDraw::kNormal, .correlation = 0.0};
  config.normal = {config.mean.length - config.sigma.length, config.mean.length + config.sigma.length, 0.1, 5.0};
  const SizeMoments moments = moments_of(config, {});
  EXPECT_NEAR(moments.covariance(0, 0) / (0.37 * 0.37), 0.29112, 1e-4);
  EXPECT_NEAR(moments.covariance(1, 1) / 0.01, 1.0, 1e-4);
}

TEST(ExpectedSize, TheDrawnOnesHaveTheseMoments) {
  const SizeConfig config{.draw = SizeDraw::kNormal};
  const SizeMoments expected = cars();
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  constexpr std::uint32_t kMany = 40'000;
  for (std::uint32_t k = 0; k < kMany; ++k) {
    const sim::world::Size size = sim::world::drawn_size(config, {}, {3, k, ObjectId{0}});
    const Eigen::Vector2d off = Eigen::Vector2d(size.length, size.width) - expected.mean;
    first += off / kMany;
    second += off * off.transpose() / kMany;
  }
  EXPECT_LT(first.norm(), 0.01);
  EXPECT_LT((second - expected.covariance).norm(), 0.02 * expected.covariance.norm());
}

// One width of variance v leaves p v / (p + v) of the variance p. It leaves an uncorrelated length as it was.
TEST(ExpectedSize, OfOneWidthItIsTheProductByTheSum) {
  const SizeMoments prior = moments_of(fusion::config::Sizes{});
  SizeRecursion recursion(prior, prior);
  recursion.see({.white = 0.01});
  EXPECT_NEAR(recursion.error()(1, 1), 0.0225 * 0.01 / (0.0225 + 0.01), 1e-12);
  EXPECT_NEAR(recursion.error()(0, 0), 0.25, 1e-12);
  EXPECT_TRUE(recursion.believed().isApprox(recursion.error(), 1e-12)) << "a right prior";
}

// With the prior of the draws, an exact width leaves (1 - correlation^2) of the length's variance.
TEST(ExpectedSize, AWidthCorrectsTheLengthByTheCorrelation) {
  for (const double correlation : {0.0, 0.5, 0.82, 1.0}) {
    const SizeMoments moments = moments_of(SizeConfig{.draw = SizeDraw::kNormal, .correlation = correlation}, {});
    SizeRecursion recursion(moments, moments);
    recursion.see({.white = 1e-9});
    EXPECT_NEAR(recursion.error()(0, 0), 0.37 * 0.37 * (1.0 - correlation * correlation), 2e-4) << correlation;
  }
}

// A wrong prior is a constant error of the side that is not seen. A correlation that is none makes it larger.
TEST(ExpectedSize, AWrongPriorHasItsPrice) {
  const SizeMoments nominal = moments_of(SizeConfig{}, {4.0, 1.7});
  SizeRecursion apart(nominal, moments_of(fusion::config::Sizes{}));
  for (int k = 0; k < 50; ++k) apart.see({.white = 0.01});
  EXPECT_NEAR(apart.error()(0, 0), 0.4 * 0.4, 1e-12);
  EXPECT_NEAR(apart.error()(1, 1), 0.01 / 50.0, 0.2 * 0.01 / 50.0);

  const fusion::config::Sizes correlated{.correlation = 0.8};
  SizeRecursion recursion(nominal, moments_of(correlated));
  recursion.see({.white = 0.01});
  // The gain of the length is 0.8 0.5 0.15 / (0.0225 + 0.01). The width was off by 0.1 m.
  const double gain = 0.06 / 0.0325;
  EXPECT_NEAR(recursion.error()(0, 0), std::pow(0.4 - gain * 0.1, 2) + gain * gain * 0.01, 1e-12);
}

// Many lists do not average an error away that repeats in every one of them.
TEST(ExpectedSize, RepeatingErrorsStay) {
  const SizeMoments prior = moments_of(fusion::config::Sizes{});
  SizeRecursion recursion(prior, prior);
  constexpr double kWhite = 0.001, kRepeating = 0.004;
  for (int k = 0; k < 1000; ++k) recursion.see({.white = kWhite, .repeating = kRepeating});
  EXPECT_NEAR(recursion.believed()(1, 1), kRepeating, 1e-9);
  // No weight of the measured widths leaves less than the first. Their mean alone leaves the second.
  EXPECT_GT(recursion.error()(1, 1), 0.0225 * kRepeating / (0.0225 + kRepeating));
  EXPECT_NEAR(recursion.error()(1, 1), kRepeating, 0.1 * kWhite);
  // Another sensor's error is another one.
  recursion.see({.sensor = 3, .white = 1e-9});
  EXPECT_LT(recursion.error()(1, 1), 1e-6);
}

// 20,000 cars. A laser sees widths, a camera a combination of both sides. Both repeat errors. The tracker's prior is wrong.
// The margin is 3 %. Sampling takes 2 % of it.
TEST(ExpectedSize, IsThatOfTheTrackersExtent) {
  const SizeMoments draws = cars();
  const fusion::config::Sizes prior{
      .length = 4.4, .length_sigma = 0.5, .width = 1.8, .width_sigma = 0.15, .correlation = 0.6};
  constexpr int kLists = 24;
  constexpr std::uint32_t kCars = 20'000;
  const auto laser_variance = [](int k) { return std::pow(0.06 + 0.004 * k, 2); };
  const Eigen::Vector2d turned(0.1, 0.95);
  constexpr double kWhite = 0.005, kRepeating = 0.0006, kOfLaser = 0.8;

  SizeRecursion recursion(draws, moments_of(prior));
  for (int k = 0; k < kLists; ++k) {
    const double variance = laser_variance(k);
    if (k % 3 == 0)
      recursion.see({0, Eigen::Vector2d::UnitY(), (1.0 - kOfLaser) * variance, kOfLaser * variance});
    else
      recursion.see({1, turned, kWhite, kRepeating});
  }

  Eigen::Matrix2d sampled = Eigen::Matrix2d::Zero();
  fusion::tracks::body::Extent extent;
  for (std::uint32_t car = 0; car < kCars; ++car) {
    const sim::world::Size drawn =
        sim::world::drawn_size(SizeConfig{.draw = SizeDraw::kNormal}, {}, {5, car, ObjectId{0}});
    const Eigen::Vector2d size(drawn.length, drawn.width);
    RandomStream noise({7, car, Purpose::kTest, 1, 0});
    const double of_laser = noise.normal(), of_camera = noise.normal();
    extent = fusion::tracks::body::Extent(prior);
    for (int k = 0; k < kLists; ++k) {
      const double sigma = std::sqrt(laser_variance(k)), white = noise.normal();
      if (k % 3 == 0) {
        const double error = sigma * (std::sqrt(kOfLaser) * of_laser + std::sqrt(1.0 - kOfLaser) * white);
        correct_width(extent, size(1) + error, sigma);
      } else {
        const double error = std::sqrt(kRepeating) * of_camera + std::sqrt(kWhite) * white;
        correct_combination(extent, turned, turned.dot(size) + error - turned.dot(extent.size), kWhite, kRepeating);
      }
    }
    sampled += (extent.size - size) * (extent.size - size).transpose() / kCars;
  }
  EXPECT_NEAR(sampled(0, 0) / recursion.error()(0, 0), 1.0, 0.03);
  EXPECT_NEAR(sampled(1, 1) / recursion.error()(1, 1), 1.0, 0.03);
  EXPECT_NEAR(sampled(0, 1), recursion.error()(0, 1),
              0.03 * std::sqrt(recursion.error()(0, 0) * recursion.error()(1, 1)));
  EXPECT_TRUE(extent.covariance.isApprox(recursion.believed(), 1e-9));
}

// The tracker's prior is read as the tracker reads it.
TEST(ExpectedSize, ThePriorIsTheExtents) {
  const fusion::config::Sizes prior = prior_of(cars());
  EXPECT_TRUE(fusion::tracks::body::Extent(prior).covariance.isApprox(moments_of(prior).covariance, 1e-12));
  EXPECT_TRUE(moments_of(prior).covariance.isApprox(cars().covariance, 1e-9));
}

}  // namespace
}  // namespace ttf::experiments::sweep
