// The covariance matches the errors. NEES and NIS of 1,000 seeded drives lie in their bands where models are
// right, and outside where they are wrong (Bar-Shalom, Li, Kirubarajan 2001, 5.4). Each drive is judged once,
// at its last step, so that the sum over drives is chi-square distributed. A band leaves 1e-4 on either side.
// For each of the seeds 1 and 2, eight of the statistics below and four variances must lie in their bands.
// Were all models right, one in two hundred other pairs of seeds would show one outside.
#include "fusion/filters/consider.h"
#include "fusion/filters/unscented.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/fusion/sensors/systematic.h"

namespace ttf::fusion::filters {
namespace {

using sensors::Measurement;
using sensors::Mounted;
using sensors::Position;
using sensors::RangeBearingRate;
using sensors::Systematic;

constexpr int kRuns = 1000, kSteps = 40;
constexpr double kDt = 0.05, kTail = 1e-4;
constexpr std::uint64_t kSeeds[] = {1, 2};

// Means over the runs, with the bands of their sums.
struct Consistency {
  double nees = 0.0, nis = 0.0;
  int states = 0, dimension = 0;
  static double quantile(double probability, int degrees) {
    return metrics::chi_square_quantile(probability, static_cast<double>(kRuns) * degrees) / kRuns;
  }
  static double lower(int degrees) { return quantile(kTail, degrees); }
  static double upper(int degrees) { return quantile(1.0 - kTail, degrees); }
  void expect_inside() const {
    EXPECT_GT(nees, lower(states));
    EXPECT_LT(nees, upper(states));
    EXPECT_GT(nis, lower(dimension));
    EXPECT_LT(nis, upper(dimension));
  }
  void expect_too_sure() const {
    EXPECT_GT(nees, upper(states));
    EXPECT_GT(nis, upper(dimension));
  }
  void expect_too_modest() const {
    EXPECT_LT(nees, lower(states));
    EXPECT_LT(nis, lower(dimension));
  }
};
class ModelConsistency : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seed, ModelConsistency, testing::ValuesIn(kSeeds));

// The world drives by `truth`, the filter assumes `model`. Measurements have `factor` times the noise that
// the filter assumes.
template <class F, class M, class S>
Consistency simulate(std::uint64_t seed, const F& filter, const M& truth, const M& model, const S& sensor,
                     const sensors::Measurement<S::kDimension>& noise, const linear::Gaussian<M::kStates>& start,
                     double factor = 1.0) {
  constexpr int kN = M::kStates, kM = S::kDimension;
  Consistency c{.states = kN, .dimension = kM};
  for (int run = 0; run < kRuns; ++run) {
    RandomStream stream({.seed = seed, .replication = static_cast<std::uint32_t>(run)});
    linear::Gaussian<kN> state = start;
    linear::Vector<kN> x = motion::drawn<kN>(start.x, start.p, stream);
    Innovation<kM> innovation;
    for (int k = 0; k < kSteps; ++k) {
      const linear::Matrix<kN> driving = truth.noise(x, kDt);
      x = motion::drawn<kN>(truth.move(x, kDt), driving, stream);
      M::normalise(x);
      const linear::Vector<kM> seen = sensor.expected(M::template kinematics<S::kParts>(x));
      filter.predict(model, state, kDt);
      const linear::Matrix<kM> r = factor * factor * noise.r;
      innovation = filter.update(model, sensor, {motion::drawn<kM>(seen, r, stream), noise.r}, state);
    }
    c.nis += innovation.nis / kRuns;
    c.nees += Ldl<kN>(state.p).norm_squared(M::difference(x, state.x)) / kRuns;
  }
  return c;
}

const sensors::Measurement<2> kLaser{.r = 0.09 * linear::Matrix<2>::Identity()};
const sensors::Measurement<3> kRadar{.r = linear::Vector<3>(0.09, 0.0001, 0.04).asDiagonal()};

linear::Gaussian<4> driving_start() {
  linear::Gaussian<4> start;
  start.x << 40.0, 10.0, -2.0, 1.0;
  start.p.diagonal() << 0.25, 0.25, 4.0, 4.0;
  return start;
}
using motion::ConstantVelocity;
const auto kalman = [](std::uint64_t seed, double true_q, double assumed_q, double factor) {
  return simulate(seed, Kalman{}, ConstantVelocity(true_q), ConstantVelocity(assumed_q), Position{}, kLaser,
                  driving_start(), factor);
};
TEST_P(ModelConsistency, Kalman) { kalman(GetParam(), 3.0, 3.0, 1.0).expect_inside(); }
TEST_P(ModelConsistency, TooLittleProcessNoiseShows) { kalman(GetParam(), 3.0, 0.3, 1.0).expect_too_sure(); }
// Ten times too much shows in the state's error. A single innovation is mostly measurement noise at these
// short steps, so only a hundred times shows there.
TEST_P(ModelConsistency, TooMuchProcessNoiseShows) {
  EXPECT_LT(kalman(GetParam(), 0.3, 3.0, 1.0).nees, Consistency::lower(4));
  kalman(GetParam(), 3.0, 300.0, 1.0).expect_too_modest();
}
TEST_P(ModelConsistency, WrongMeasurementNoiseShows) {
  kalman(GetParam(), 3.0, 3.0, 2.0).expect_too_sure();
  kalman(GetParam(), 3.0, 3.0, 0.5).expect_too_modest();
}

// Known well enough for linearisation.
linear::Gaussian<5> turning_start() {
  linear::Gaussian<5> start;
  start.x << 40.0, 10.0, 2.0, 8.0, 0.3;
  start.p.diagonal() << 0.04, 0.04, 0.0025, 0.25, 0.0025;
  return start;
}
const sensors::Mounted<RangeBearingRate> kFromTheBumper({.position = {3.5, 0.5}, .yaw = 0.2});
template <class F> Consistency turning(std::uint64_t seed, const F& filter, double assumed) {
  const motion::Ctrv truth(0.02, 0.5), model(0.02 * assumed, 0.5 * assumed);
  return simulate(seed, filter, truth, model, kFromTheBumper, kRadar, turning_start());
}
TEST_P(ModelConsistency, ExtendedAlongBends) {
  turning(GetParam(), Extended{}, 1.0).expect_inside();
  turning(GetParam(), Extended{}, 0.05).expect_too_sure();
}
TEST_P(ModelConsistency, UnscentedAlongBends) {
  turning(GetParam(), Unscented{}, 1.0).expect_inside();
  turning(GetParam(), Unscented{}, 0.05).expect_too_sure();
}

// A laser 0.2 m off its place, with stamps 20 ms late (sigmas): drawn for each drive, constant during it.
struct WithBias {
  Consistency considered, ignored;
  linear::Matrix<4> mse = linear::Matrix<4>::Zero(), p = linear::Matrix<4>::Zero();
};
WithBias simulate_bias(std::uint64_t seed) {
  WithBias out{.considered = {.states = 4, .dimension = 2}, .ignored = {.states = 4, .dimension = 2}};
  const ConstantVelocity model(0.5);
  const sensors::Systematic<Position> as_known{};
  for (int run = 0; run < kRuns; ++run) {
    RandomStream stream({.seed = seed, .replication = static_cast<std::uint32_t>(run)});
    Considered<4, 3> considered{.state = driving_start()};
    const Consider<3> filter{.bias = linear::Matrix<3>(linear::Vector<3>(0.04, 0.04, 0.0004).asDiagonal())};
    linear::Gaussian<4> ignorant = considered.state;
    linear::Vector<4> x = motion::drawn<4>(ignorant.x, ignorant.p, stream);
    const linear::Vector<3> bias = motion::drawn<3>(linear::Vector<3>::Zero(), filter.bias, stream);
    const sensors::Systematic<Position> as_it_is{{}, bias.head<2>(), bias(2)};
    Innovation<2> a, b;
    for (int k = 0; k < kSteps; ++k) {
      x = motion::drawn<4>(model.move(x, kDt), model.noise(x, kDt), stream);
      const linear::Vector<2> seen = as_it_is.expected(ConstantVelocity::kinematics<motion::kWithVelocity>(x));
      const sensors::Measurement<2> z{motion::drawn<2>(seen, kLaser.r, stream), kLaser.r};
      filter.predict(model, considered, kDt);
      a = filter.update(model, as_known, z, considered);
      Kalman{}.predict(model, ignorant, kDt);
      b = Kalman{}.update(model, Position{}, z, ignorant);
    }
    const linear::Vector<4> error = x - considered.state.x;
    out.considered.nis += a.nis / kRuns;
    out.considered.nees += Ldl<4>(considered.state.p).norm_squared(error) / kRuns;
    out.ignored.nis += b.nis / kRuns;
    out.ignored.nees += Ldl<4>(ignorant.p).norm_squared(x - ignorant.x) / kRuns;
    motion::add_outer<4>(out.mse, 1.0 / kRuns, error);
    motion::add_scaled<4, 4>(out.p, 1.0 / kRuns, considered.state.p);
  }
  return out;
}
TEST_P(ModelConsistency, ConsideredBiasIsInTheCovariance) {
  const WithBias with = simulate_bias(GetParam());
  with.considered.expect_inside();
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(with.mse(i, i) / with.p(i, i), Consistency::lower(1)) << i;
    EXPECT_LT(with.mse(i, i) / with.p(i, i), Consistency::upper(1)) << i;
  }
  EXPECT_GT(with.p(0, 0), 0.04) << "never better than the bias";
  EXPECT_GT(with.ignored.nees, Consistency::upper(4)) << "ignoring it is inconsistent";
}

}  // namespace
}  // namespace ttf::fusion::filters
