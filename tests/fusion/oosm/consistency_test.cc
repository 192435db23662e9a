// Normalised estimation error squared over 1,000 seeded runs: inside its band where covariances are true,
// outside where they are not. A band leaves 1e-4 on either side. For each of the seeds 1 and 2, seventeen
// statistics must lie in their bands. Those equal up to rounding (of exact methods) are not counted. Fewer
// than one in a hundred other pairs of seeds would show one outside.
//
//   0 . 1 . 2 . . . 11 . 12     positions once a second; at last, one from the middle of the interval `lag` back
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>

#include "fusion/metrics/chi_square.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/oosm/any_methods.h"

namespace ttf::fusion::oosm {
namespace {

constexpr int kRuns = 1000, kLists = 12;
constexpr std::uint64_t kSeeds[] = {1, 2};

template <int M> struct Setting {
  Line motion;
  int lag = 1;
  linear::Matrix<M, 2> h;
  linear::Vector<M> r;  // variances
};
const Setting<1> kPosition{Line{}, 1, linear::Matrix<1, 2>(1.0, 0.0), linear::Vector<1>(0.5)};

// One run's measurements in order of arrival; `truth` is the state at the last list.
template <int M>
Timeline<2, M> run_of(std::uint64_t seed, const Setting<M>& setting, std::uint32_t replication,
                      linear::Vector<2>& truth) {
  RandomStream stream({.seed = seed, .replication = replication});
  truth = drawn<2, 1>(stream);
  const linear::LinearStep<2> half = setting.motion.step(0.5);
  const linear::Matrix<2> root = half.q.llt().matrixL();
  Timeline<2, M> arrivals;
  Event<2, M> late;
  for (int i = 1; i <= 2 * kLists; ++i) {
    truth = (half.f * truth + root * drawn<2, 1>(stream)).eval();
    linear::LinearMeasurement<2, M> seen;
    seen.h = setting.h;
    seen.r = setting.r.asDiagonal();
    seen.z = setting.h * truth + setting.r.cwiseSqrt().asDiagonal() * drawn<M, 1>(stream);
    if (i % 2 == 0) arrivals.push_back({stamp_at(after_ms(500 * i)), seen});
    if (i == 2 * (kLists - setting.lag) + 1) late = {stamp_at(after_ms(500 * i), 1), seen};
  }
  arrivals.push_back(late);
  return arrivals;
}

using Estimator = std::function<linear::Gaussian<2>(const ttf::fusion::oosm::Timeline<2, 1>&)>;

double squared_error(const linear::Gaussian<2>& estimate, const linear::Vector<2>& truth) {
  const linear::Vector<2> e = truth - estimate.x;
  return norm_squared(e, estimate.p);
}
double average_nees(std::uint64_t seed, const Setting<1>& setting, const Estimator& estimate) {
  double sum = 0.0;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    linear::Vector<2> truth;
    const Timeline<2, 1> arrivals = run_of(seed, setting, run, truth);
    sum += squared_error(estimate(arrivals), truth);
  }
  return sum / kRuns;
}
double nees_of(std::uint64_t seed, Kind kind, const Setting<1>& setting) {
  return average_nees(seed, setting, [&](const Timeline<2, 1>& arrivals) {
    OnLine method(kind, setting.motion);
    method.start(GlobalTime{}, {linear::Vector<2>::Zero(), linear::Matrix<2>::Identity()});
    take_all(method, arrivals);
    return method.state();
  });
}

// The average of chi-squares of two degrees of freedom.
void expect_inside(double nees) {
  EXPECT_GT(nees, metrics::chi_square_quantile(1e-4, 2.0 * kRuns) / kRuns);
  EXPECT_LT(nees, metrics::chi_square_quantile(1.0 - 1e-4, 2.0 * kRuns) / kRuns);
}
constexpr double kFarOutside = 2.5;  // eight sigmas

Setting<1> positions_with(double q, int lag) {
  Setting<1> setting = kPosition;
  setting.motion.q = q;
  setting.lag = lag;
  return setting;
}

class Consistent : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Exact, Consistent,
                         testing::Values(Kind::kRewind, Kind::kAugmented, Kind::kClone, Kind::kAdjoint), kind_of);
TEST_P(Consistent, AtEveryLagAndNoise) {
  for (const std::uint64_t seed : kSeeds)
    for (const double q : {0.1, 1.0, 4.0})
      for (const int lag : {1, 3, 8}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", q " << q << ", lag " << lag);
        expect_inside(nees_of(seed, GetParam(), positions_with(q, lag)));
      }
}

class Consistency : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seed, Consistency, testing::ValuesIn(kSeeds));
TEST_P(Consistency, OfAAndBAtOneLag) {
  for (const double q : {0.1, 1.0, 4.0})
    for (const Kind kind : {Kind::kA, Kind::kB, Kind::kAl1, Kind::kBl1}) {
      SCOPED_TRACE(testing::Message() << name_of(kind) << ", q " << q);
      expect_inside(nees_of(GetParam(), kind, positions_with(q, 1)));
    }
}

// Position and velocity measured, as in table IV of Bar-Shalom 2002. With more noise, C is more
// overconfident.
TEST_P(Consistency, CIsOutsideAtHighNoise) {
  Setting<2> setting{Line{4.0}, 1, linear::Matrix<2>::Identity(), linear::Vector<2>(1.0, 0.1)};
  double sum_a = 0.0, sum_c = 0.0;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    linear::Vector<2> truth;
    const Timeline<2, 2> arrivals = run_of(GetParam(), setting, run, truth);
    const auto error = [&](auto method) {
      method.start(GlobalTime{}, {linear::Vector<2>::Zero(), linear::Matrix<2>::Identity()});
      take_all(method, arrivals);
      return squared_error(method.state(), truth);
    };
    sum_a += error(AlgorithmA<2, 2, Line>(setting.motion));
    sum_c += error(AlgorithmC<2, 2, Line>(setting.motion));
  }
  expect_inside(sum_a / kRuns);
  EXPECT_GT(sum_c / kRuns, kFarOutside);
}

// Bl1's mean with Al1's covariance, five lags back: an inconsistent pair.
TEST_P(Consistency, TheMixOfAl1AndBl1IsOutside) {
  const Setting<1> setting = positions_with(4.0, 5);
  const double mixed = average_nees(GetParam(), setting, [&](const Timeline<2, 1>& arrivals) {
    linear::Gaussian<2> now{linear::Vector<2>::Zero(), linear::Matrix<2>::Identity()}, before;
    GlobalTime time{};
    const auto& late = arrivals.back();
    for (auto event = arrivals.begin(); event + 1 != arrivals.end(); ++event) {
      advance<2>(now, setting.motion, event->stamp.time() - time);
      correct<2, 1>(now, event->measurement);
      time = event->stamp.time();
      if (event->stamp < late.stamp) before = now;
    }
    predict<2>(before, setting.motion.step(5.0));
    const linear::LinearStep<2> step = setting.motion.step(4.5);
    Retrodicted<2> mix = retrodict_collapsed<2>(now, before, step, linear::Vector<2>::Zero(), Noise::kRetrodicted);
    mix.then.x = retrodict_collapsed<2>(now, before, step, linear::Vector<2>::Zero(), Noise::kIgnored).then.x;
    fuse_retrodicted<2, 1>(now, mix, late.measurement);
    return now;
  });
  EXPECT_GT(mixed, kFarOutside);
  expect_inside(nees_of(GetParam(), Kind::kRewind, setting));
}

}  // namespace
}  // namespace ttf::fusion::oosm
