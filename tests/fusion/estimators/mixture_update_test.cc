// The update by several explanations (law 5 of fusion/estimators/estimator.h) for every motion model and
// filter. Linear ones are checked against the equations of probabilistic data association.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fusion/estimators/estimator.h"
#include "tests/fusion/choices.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/scenes.h"

namespace ttf::fusion::estimators {
namespace {

class MixtureUpdate : public testing::TestWithParam<Choice> {
 protected:
  const config::TrackerConfig config = config_of(std::get<0>(GetParam()), 1.0, std::get<1>(GetParam()));
  const std::shared_ptr<const Estimator> estimator = make_estimator(config);
};
INSTANTIATE_TEST_SUITE_P(All, MixtureUpdate, every_choice(), name_of_choice);

// A drive that stands, drives off and turns. Positions and a radar's measurements alternate, each with an
// echo beside.
TEST_P(MixtureUpdate, KeepsTheLawsAlongADrive) {
  RandomStream stream({.seed = 11});
  linear::Vector<2> at(30.0, -8.0);
  Estimate estimate = estimator->initial(position(at(0), at(1), 0.3));
  double heading = 2.5, speed = 0.0;
  for (int k = 1; k <= 500; ++k) {
    speed = k < 60 ? 0.0 : k < 400 ? std::min(10.0, speed + 0.2) : std::max(0.0, speed - 0.3);
    if (k >= 150 && k < 280) heading += 0.02;
    const linear::Vector<2> velocity = speed * linear::Vector<2>(std::cos(heading), std::sin(heading));
    at += 0.05 * velocity;
    estimator->predict(estimate, 0.05);
    const double range = at.norm(), bearing = std::atan2(at(1), at(0)), rate = at.dot(velocity) / range;
    const auto see = [&](double off) {
      const double a = off + 0.2 * stream.normal(), b = 0.2 * stream.normal();
      return k % 2 ? position(at(0) + a, at(1) + b, 0.2)
                   : radar(range + a, bearing + 0.1 * b, rate + b, 0.3, 0.02, 0.3);
    };
    const std::array<sensors::Observation, 2> z{see(0.0), see(0.7)};
    const Estimate before = estimate;

    Estimate by_one = before, by_weight = before;
    estimator->update(by_one, z[0]);
    estimator->update(by_weight, std::array{Explanation{nullptr, 0.0}, Explanation{&z[0], 1.0}});
    ASSERT_TRUE(same_bits(by_one, by_weight)) << k << ": of weight 1, it is the update";
    Estimate untouched = before;
    estimator->update(untouched, std::array{Explanation{nullptr, 1.0}, Explanation{&z[1], 0.0}});
    ASSERT_TRUE(same_bits(untouched, before)) << k << ": and of none, nothing";

    const std::array mixture{Explanation{nullptr, 0.1}, Explanation{&z[0], 0.7}, Explanation{&z[1], 0.2}};
    const std::array otherwise{mixture[2], mixture[0], mixture[1]};
    Estimate in_order = before, shuffled = before, again = before;
    estimator->update(in_order, mixture);
    estimator->update(shuffled, otherwise);
    estimator->update(again, mixture);
    ASSERT_TRUE(same_bits(in_order, again)) << k;
    const Cartesian one = estimator->cartesian(in_order), other = estimator->cartesian(shuffled);
    ASSERT_EQ(in_order.index(), shuffled.index()) << k;
    ASSERT_LT((one.x - other.x).norm(), 1e-6 * (1.0 + one.x.norm())) << k;
    ASSERT_TRUE(one.x.allFinite() && one.p.allFinite()) << k;
    ASSERT_EQ(one.p, one.p.transpose().eval()) << k;
    ASSERT_GT(least_eigenvalue(one.p), -1e-9 * one.p.trace()) << k;

    const auto fit = estimator->fit(before, z[0]);
    const auto distance = estimator->distance_squared(before, z[0]);
    ASSERT_EQ(fit.has_value(), distance.has_value()) << k;
    if (fit) {
      ASSERT_EQ(fit->distance_squared, *distance) << k;
    }
    estimate = in_order;
  }
  EXPECT_LT((estimator->cartesian(estimate).x.head<2>() - at).norm(), 1.5);
}

// Bar-Shalom, Fortmann 1988, 6.4: one gain, the combined innovation, P^c, the spread of the innovations.
TEST(MixtureUpdate, OfALinearFilterIsProbabilisticDataAssociation) {
  RandomStream stream({.seed = 12});
  const auto estimator = make_estimator({});
  for (int draw_number = 0; draw_number < 200; ++draw_number) {
    linear::Matrix<4> root;
    for (int i = 0; i < 16; ++i) root.data()[i] = stream.normal();
    linear::Gaussian<4> prior;
    prior.p = root * root.transpose();
    for (int i = 0; i < 4; ++i) prior.x(i) = stream.normal();
    linear::symmetrise<4>(prior.p);
    const auto count = static_cast<std::size_t>(stream.integer(1, 4));
    std::vector<sensors::Observation> z;
    std::vector<double> beta{stream.uniform(0.1, 1.0)};
    for (std::size_t i = 0; i < count; ++i) {
      z.push_back(position(stream.normal(), stream.normal(), 0.6));
      beta.push_back(stream.uniform(0.1, 1.0));
    }
    double sum = 0.0;
    for (const double b : beta) sum += b;
    for (double& b : beta) b /= sum;
    std::vector<Explanation> explanations{{nullptr, beta[0]}};
    for (std::size_t i = 0; i < count; ++i) explanations.push_back({&z[i], beta[i + 1]});
    Estimate estimate = prior;
    estimator->update(estimate, explanations);

    const linear::Matrix<2> s = prior.p.topLeftCorner<2, 2>() + 0.36 * linear::Matrix<2>::Identity();
    const linear::Matrix<4, 2> gain = prior.p.leftCols<2>() * linear::Matrix<2>(inverse(s));
    const linear::Matrix<4> conditional = prior.p - gain * s * gain.transpose();
    linear::Vector<2> combined = linear::Vector<2>::Zero();
    linear::Matrix<2> spread = linear::Matrix<2>::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const linear::Vector<2> nu = z[i].z.head<2>() - prior.x.head<2>();
      combined += beta[i + 1] * nu;
      spread += beta[i + 1] * nu * nu.transpose();
    }
    spread -= combined * combined.transpose();
    const linear::Vector<4> x = prior.x + gain * combined;
    const linear::Matrix<4> p = beta[0] * prior.p + (1.0 - beta[0]) * conditional + gain * spread * gain.transpose();
    const auto& found = std::get<linear::Gaussian<4>>(estimate);
    EXPECT_LT((found.x - x).norm(), 1e-12 * (1.0 + x.norm()));
    EXPECT_LT((found.p - p).norm(), 1e-12 * p.norm());
  }
}

TEST(Fit, DensityIsThatOfTheInnovation) {
  const auto estimator = make_estimator({});
  const Estimate estimate = linear::Gaussian<4>{linear::Vector<4>(10.0, 2.0, 0.0, 0.0), linear::Matrix<4>::Identity()};
  const Fit fit = estimator->fit(estimate, position(11.0, 2.0, 1.0)).value();
  EXPECT_DOUBLE_EQ(fit.distance_squared, 0.5);
  EXPECT_NEAR(fit.density, std::exp(-0.25) / (2.0 * kPi * 2.0), 1e-15);
}

}  // namespace
}  // namespace ttf::fusion::estimators
