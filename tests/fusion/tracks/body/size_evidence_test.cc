// Evidence of sizes is that of the measurements alone, whatever the prior.
#include "fusion/tracks/body/size_evidence.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"

namespace ttf::fusion::tracks::body {
namespace {

using config::Sizes;

const Sizes kCar{4.4, 0.5, 1.8, 0.15, 0.0};
const Sizes kOthers[] = {
    {12.0, 2.5, 2.5, 0.1, 0.0}, {5.5, 0.5, 2.0, 0.1, 0.0}, {4.65, 0.37, 1.76, 0.1, 0.82}, {3.0, 1.0, 1.5, 0.4, -0.6}};

// h' (length, width) with white noise of this variance.
struct Measurement {
  Eigen::Vector2d h;
  double value, variance;
};

Eigen::Matrix2d covariance_of(const Sizes& prior) {
  const double cross = prior.correlation * prior.length_sigma * prior.width_sigma;
  Eigen::Matrix2d p;
  p << prior.length_sigma * prior.length_sigma, cross, cross, prior.width_sigma * prior.width_sigma;
  return p;
}

// The measurements of a car, and the extent that they gave it.
struct Measured {
  Extent extent{kCar};
  std::vector<Measurement> all;

  // Each known well enough to stay below the bound of errors that repeat (fusion/tracks/body/extent.h).
  explicit Measured(std::uint64_t seed) {
    RandomStream stream({.seed = seed});
    const double length = 4.4 + 0.2 * stream.normal(), width = 1.8 + 0.05 * stream.normal();
    correct_length(extent, length, 0.2);
    correct_width(extent, width, 0.05);
    all = {{Eigen::Vector2d::UnitX(), length, 0.04}, {Eigen::Vector2d::UnitY(), width, 0.0025}};
    for (int k = 0; k < 4; ++k) {
      const double turn = stream.uniform(0.0, 1.5);
      const Eigen::Vector2d h(std::sin(turn), std::cos(turn));
      const double value = h.dot(Eigen::Vector2d(4.4, 1.8)) + 0.2 * stream.normal();
      correct_combination(extent, h, value - h.dot(extent.size), 0.04, 0.0);
      all.push_back({h, value, 0.04});
    }
  }

  // Oracle: N(H m, H P H' + R) of all measurements together.
  Explained at_once(const Sizes& prior) const {
    const auto n = static_cast<Eigen::Index>(all.size());
    Eigen::MatrixXd h(n, 2);
    Eigen::VectorXd y(n), r(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Measurement& one = all[static_cast<std::size_t>(i)];
      h.row(i) = one.h.transpose();
      y(i) = one.value;
      r(i) = one.variance;
    }
    const Eigen::Vector2d mean(prior.length, prior.width);
    const Eigen::Matrix2d p = covariance_of(prior);
    const Eigen::LDLT<Eigen::MatrixXd> s(h * p * h.transpose() + Eigen::MatrixXd(r.asDiagonal()));
    const Eigen::VectorXd nu = y - h * mean;
    Explained result{Extent(prior)};
    result.extent.size = mean + p * h.transpose() * s.solve(nu);
    result.extent.covariance = p - p * h.transpose() * s.solve(h * p);
    result.log_likelihood = -0.5 * (nu.dot(s.solve(nu)) + s.vectorD().array().log().sum());
    return result;
  }
};

// Oracle: ln of the integral of prior times likelihood, over a grid, up to a constant.
double integrated(const Sizes& prior, const std::vector<Measurement>& all) {
  const Eigen::LDLT<Eigen::Matrix2d> p(covariance_of(prior));
  std::vector<double> logs;
  for (double length = -1.0; length < 14.0; length += 0.02)
    for (double width = -0.5; width < 4.0; width += 0.01) {
      const Eigen::Vector2d size(length, width), off = size - Eigen::Vector2d(prior.length, prior.width);
      double log = -0.5 * (off.dot(p.solve(off)) + p.vectorD().array().log().sum());
      for (const Measurement& one : all) {
        const double nu = one.value - one.h.dot(size);
        log -= 0.5 * nu * nu / one.variance;
      }
      logs.push_back(log);
    }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double log : logs) sum += std::exp(log - most);
  return most + std::log(sum);
}

void expect_near(const Extent& a, const Extent& b, double tolerance) {
  EXPECT_LT((a.size - b.size).norm(), tolerance) << a.size.transpose() << " and " << b.size.transpose();
  EXPECT_LT((a.covariance - b.covariance).norm(), tolerance) << a.covariance << "\n and\n" << b.covariance;
}

TEST(SizeEvidence, AnotherPriorGetsTheExtentThatTheMeasurementsWouldHaveGivenIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Measured measured(seed);
    expect_near(measured.extent, measured.at_once(kCar).extent, 1e-9);
    const SizeEvidence evidence = evidence_of(measured.extent, kCar);
    for (const Sizes& other : kOthers) {
      const Extent extent = explained(evidence, other).extent;
      expect_near(extent, measured.at_once(other).extent, 1e-9);
      EXPECT_EQ(extent.prior_variances, covariance_of(other).diagonal()) << "measured is what is better than by it";
    }
  }
}

TEST(SizeEvidence, ItsLikelihoodsDifferLikeThoseOfTheMeasurements) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Measured measured(seed);
    const SizeEvidence evidence = evidence_of(measured.extent, kCar);
    for (const Sizes& other : kOthers)
      EXPECT_NEAR(explained(evidence, other).log_likelihood - explained(evidence, kCar).log_likelihood,
                  measured.at_once(other).log_likelihood - measured.at_once(kCar).log_likelihood, 1e-7);
  }
}

TEST(SizeEvidence, ItsLikelihoodsDifferLikeIntegralsOverAllSizes) {
  const Measured measured(7);
  const SizeEvidence evidence = evidence_of(measured.extent, kCar);
  const double car = integrated(kCar, measured.all);
  for (const Sizes& other : kOthers)
    EXPECT_NEAR(explained(evidence, other).log_likelihood - explained(evidence, kCar).log_likelihood,
                integrated(other, measured.all) - car, 1e-6);
}

TEST(SizeEvidence, ThePriorThatAnExtentBeganWithGivesItBack) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Measured measured(seed);
    expect_near(explained(evidence_of(measured.extent, kCar), kCar).extent, measured.extent, 1e-9);
  }
  const Explained unmeasured = explained(evidence_of(Extent(kCar), kCar), kCar);
  expect_near(unmeasured.extent, Extent(kCar), 1e-12);
  EXPECT_NEAR(unmeasured.log_likelihood, 0.0, 1e-12) << "nothing was measured";
}

// 20 m^2 are more than the prior's variances.
TEST(SizeEvidence, AWalkThatForgotEverythingLeavesNone) {
  Extent extent(kCar);
  correct_width(extent, 2.5, 0.05);
  predict(extent, 1.0, 20.0);
  const SizeEvidence evidence = evidence_of(extent, kCar);
  EXPECT_EQ(evidence.information, Eigen::Matrix2d::Zero());
  EXPECT_EQ(evidence.weighted, Eigen::Vector2d::Zero());
  for (const Sizes& other : kOthers) {
    const Explained by = explained(evidence, other);
    expect_near(by.extent, Extent(other), 1e-9);
    EXPECT_NEAR(by.log_likelihood, 0.0, 1e-9);
  }
}

// Any measurements, with walks in between that lose a little, much, or all on one axis only.
TEST(SizeEvidence, AWalkThatLostMoreThanWasMeasuredLeavesUsableExtents) {
  RandomStream stream({.seed = 9});
  for (int round = 0; round < 2000; ++round) {
    Extent extent(kCar);
    for (int k = 0; k < 6; ++k) {
      const double sigma = std::exp(stream.uniform(-6.0, 2.0));
      switch (stream.integer(0, 3)) {
        case 0: correct_length(extent, stream.uniform(0.1, 20.0), sigma); break;
        case 1: correct_width(extent, stream.uniform(0.1, 5.0), sigma); break;
        case 2:
          correct_combination(extent, {stream.normal(), stream.normal()}, stream.normal(), sigma * sigma, 0.0);
          break;
        default: predict(extent, std::exp(stream.uniform(-12.0, 2.0)), stream.uniform()); break;
      }
    }
    const SizeEvidence evidence = evidence_of(extent, kCar);
    ASSERT_TRUE(evidence.information.allFinite() && evidence.weighted.allFinite());
    const double scale = std::max(1.0, evidence.information.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(evidence.information);
    ASSERT_GE(axes.eigenvalues().minCoeff(), -1e-12 * scale);
    for (const Sizes& other : kOthers) {
      const Explained by = explained(evidence, other);
      ASSERT_TRUE(by.extent.size.allFinite() && by.extent.covariance.allFinite() && std::isfinite(by.log_likelihood));
      ASSERT_EQ(by.extent.covariance(0, 1), by.extent.covariance(1, 0));
      ASSERT_EQ(Eigen::LLT<Eigen::Matrix2d>(by.extent.covariance).info(), Eigen::Success) << by.extent.covariance;
    }
  }
}

}  // namespace
}  // namespace ttf::fusion::tracks::body
