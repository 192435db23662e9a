// Filters of one object against closed forms and second implementations. These are the dense linear filter
// (textbook.h), the information form, the scalar Riccati equation, and the state augmented by the biases.
#include <Eigen/LU>

#include "fusion/filters/consider.h"
#include "fusion/filters/unscented.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "tests/fusion/dense.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/fusion/sensors/position_heading.h"
#include "tests/fusion/sensors/systematic.h"
#include "tests/fusion/textbook.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::filters {
namespace {

using sensors::Measurement;
using sensors::Mounted;
using sensors::Position;
using sensors::PositionHeading;
using sensors::RangeBearingRate;
using sensors::Systematic;

TEST(SmallLdl, SolvesAndMeasures) {
  RandomStream stream({.seed = 10});
  for (int i = 0; i < 50; ++i) {
    const linear::Matrix<3> a = motion::drawn_covariance<3>(stream, 2.0);
    const linear::Vector<3> v = motion::drawn<3>(linear::Vector<3>::Zero(), a, stream);
    const Ldl<3> ldl(a);
    const linear::Vector<3> x = ldl.divide<1>(v.transpose()).transpose(), back = motion::times<3, 3, 1>(a, x);
    EXPECT_LT((motion::apart<3, 1>(back, v)), 1e-13);
    EXPECT_NEAR(ldl.norm_squared(v), v.dot(x), 1e-11);
    EXPECT_NEAR(ldl.determinant() / a.determinant(), 1.0, 1e-12);
  }
  EXPECT_DEATH(Ldl<3>(-linear::Matrix<3>::Identity()), "not positive definite");
}
TEST(PositiveDefinite, IsWhatCanBeFactored) {
  RandomStream stream({.seed = 15});
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(positive_definite<3>(motion::drawn_covariance<3>(stream, 0.01)));
  EXPECT_TRUE(positive_definite<2>(linear::Matrix<2>(linear::Vector<2>(1e12, 1e-12).asDiagonal())))
      << "units do not matter";
  const auto of = [](double a, double b, double c, double d) {
    linear::Matrix<2> m;
    m << a, b, c, d;
    return positive_definite<2>(m);
  };
  EXPECT_TRUE(of(4.0, 1.9, 1.9, 1.0));
  EXPECT_FALSE(of(4.0, 2.0, 2.0, 1.0)) << "two that are one";
  EXPECT_FALSE(of(4.0, 2.1, 2.1, 1.0)) << "correlated by more than one";
  EXPECT_FALSE(of(4.0, 1.9, 1.8, 1.0)) << "not symmetric";
  EXPECT_FALSE(of(0.0, 0.0, 0.0, 1.0)) << "known exactly";
  EXPECT_FALSE(of(1.0, 0.0, 0.0, -1.0));
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_FALSE(of(infinity, 0.0, 0.0, 1.0));
  EXPECT_FALSE(of(1.0, 0.0, 0.0, nan));
  EXPECT_FALSE(of(1.0, nan, nan, 1.0));
  EXPECT_FALSE(of(1.0, infinity, infinity, 1.0));
}
TEST(SquareRoot, OfWhatIsCertainInPart) {
  linear::Matrix<3> p;
  p << 4.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0;  // two components that move as one, a known third
  const linear::Matrix<3> a = square_root<3>(p);
  EXPECT_LT((motion::apart<3, 3>(motion::times_transposed<3, 3, 3>(a, a), p)), 1e-15);
  EXPECT_EQ(a.col(2).norm(), 0.0);
}

// A scalar random walk, Q = 0.7 per step, R = 1.3. Its steady state after an update is P = (sqrt(Q^2 + 4 Q R)
// - Q) / 2.
TEST(JosephUpdate, ReachesTheRiccatiEquationsFixedPoint) {
  const double q = 0.7, r = 1.3;
  linear::Gaussian<1> state{linear::Vector<1>::Zero(), linear::Matrix<1>::Constant(100.0)};
  for (int k = 0; k < 100; ++k) {
    state.p(0, 0) += q;
    correct<true, 1, 1, 1>(state, linear::Vector<1>::Zero(), linear::Matrix<1>::Identity(),
                           linear::Matrix<1>::Constant(r));
  }
  EXPECT_NEAR(state.p(0, 0), 0.5 * (std::sqrt(q * q + 4.0 * q * r) - q), 1e-15);
}
// An object known to stand still: its estimate is the mean of its measurements, with R / n.
TEST(JosephUpdate, OfWhatStandsIsTheMean) {
  motion::ConstantVelocity model(0.0);
  linear::Gaussian<4> state;
  state.p(0, 0) = state.p(1, 1) = 1e12;
  double sum = 0.0;
  for (int k = 1; k <= 50; ++k) {
    Kalman{}.predict(model, state, 0.1);
    Kalman{}.update(model, Position{},
                    sensors::Measurement<2>{{std::sin(k), 0.0}, 0.25 * linear::Matrix<2>::Identity()}, state);
    sum += std::sin(k);
  }
  EXPECT_NEAR(state.x(0), sum / 50.0, 1e-9);
  EXPECT_NEAR(state.p(0, 0), 0.25 / 50.0, 1e-9);
}
// A millimetre's measurement of a point known to 100 m: the covariance stays positive and symmetric.
TEST(JosephUpdate, StaysPositiveWhereNumbersAreFarApart) {
  motion::ConstantVelocity model(1e-3);
  linear::Gaussian<4> state;
  state.p = 1e4 * linear::Matrix<4>::Identity();
  const sensors::Measurement<2> z{{1.0, 2.0}, 1e-6 * linear::Matrix<2>::Identity()};
  for (int k = 0; k < 20; ++k) {
    Kalman{}.predict(model, state, 0.05);
    Kalman{}.update(model, Position{}, z, state);
    EXPECT_TRUE(motion::symmetric<4>(state.p));
    EXPECT_GT(state.p(0, 0), 1e-7);
    EXPECT_LT(state.p(0, 0), 1.001e-6);
    for (int i = 0; i < 4; ++i) EXPECT_GT(state.p(i, i), 0.0);
    EXPECT_GT(state.p(0, 0) * state.p(2, 2) - state.p(0, 2) * state.p(0, 2), 0.0);
  }
}

// H of all components, as the textbook has it.
template <class M, class S>
linear::LinearMeasurement<M::kStates, S::kDimension> linearised(const S& sensor,
                                                                const sensors::Measurement<S::kDimension>& z,
                                                                const linear::Vector<M::kStates>& x) {
  const motion::Kinematics k = M::template kinematics<motion::kWithHeading>(x);
  linear::LinearMeasurement<M::kStates, S::kDimension> out;
  linear::Matrix<S::kDimension, 5> h = linear::Matrix<S::kDimension, 5>::Zero();
  h.template leftCols<S::kParts>() = sensor.jacobian(k);
  out.h.template leftCols<4>() = motion::times<S::kDimension, 5, 4>(h, M::kinematics_jacobian(x));
  out.z = sensor.residual(z.z, sensor.expected(k)) + motion::times<S::kDimension, M::kStates, 1>(out.h, x);
  out.r = z.r;
  return out;
}

// Bit for bit: a gate's innovation is the update's.
template <int M> void expect_same(const Innovation<M>& a, const Innovation<M>& b) {
  EXPECT_TRUE((motion::same<M, 1>(a.nu, b.nu) && motion::same<M, M>(a.s, b.s)));
  EXPECT_EQ(a.nis, b.nis);
  EXPECT_EQ(a.determinant, b.determinant);
  EXPECT_EQ(a.used, b.used);
}

// The filter against the dense one, step by step, with measurements of a vehicle ahead.
template <class F, class M, class S> void is_the_dense_filter(const M& model, const S& sensor, double tolerance) {
  constexpr int kN = M::kStates, kM = S::kDimension;
  RandomStream stream({.seed = 11});
  linear::Gaussian<kN> state;
  state.x.template head<4>() << 30.0, 8.0, 1.0, 2.0;
  state.p = motion::drawn_covariance<kN>(stream, 0.3);
  linear::Gaussian<kN> dense = state;
  for (int k = 0; k < 40; ++k) {
    const double dt = stream.uniform(0.0, 0.2);
    linear::LinearStep<kN> step{model.jacobian(dense.x, dt), model.noise(dense.x, dt)};
    const linear::Vector<kN> moved = model.move(dense.x, dt);
    linear::predict<kN>(dense, step);
    dense.x = moved;
    F{}.predict(model, state, dt);
    sensors::Measurement<kM> z;
    z.r = motion::drawn_covariance<kM>(stream, 0.2);
    z.z = motion::drawn<kM>(sensor.expected(M::template kinematics<S::kParts>(dense.x)), z.r, stream);
    const auto expected = update<kN, kM>(dense, linearised<M>(sensor, z, dense.x));
    const Innovation<kM> asked = F{}.innovate(model, sensor, z, state);
    const Innovation<kM> innovation = F{}.update(model, sensor, z, state);
    ASSERT_TRUE(innovation.used);
    expect_same<kM>(asked, innovation);
    EXPECT_LT((motion::apart<kM, 1>(innovation.nu, expected.nu)), tolerance);
    EXPECT_LT((motion::apart<kM, kM>(innovation.s, expected.s)), tolerance);
    EXPECT_LT(M::difference(state.x, dense.x).norm() / dense.x.norm(), tolerance) << k;
    EXPECT_LT((motion::apart<kN, kN>(state.p, dense.p)), tolerance) << k;
    EXPECT_NEAR(innovation.nis, Ldl<kM>(expected.s).norm_squared(expected.nu), 1e-9);
  }
}
const sensors::Mounting kPlace{.position = {3.5, -0.4}, .yaw = 0.3};

TEST(KalmanFilter, IsTheDenseFilter) {
  is_the_dense_filter<Kalman>(motion::ConstantVelocity(2.0), Position{}, 1e-13);
  is_the_dense_filter<Kalman>(motion::ConstantAcceleration(2.0), sensors::Mounted<Position>(kPlace), 1e-13);
}
TEST(ExtendedFilter, IsTheDenseFilterLinearised) {
  is_the_dense_filter<Extended>(motion::Ctra(0.3, 2.0), sensors::Mounted<RangeBearingRate>(kPlace), 1e-12);
}
TEST(ExtendedFilter, IsTheKalmanFilterOnLinearModels) {
  is_the_dense_filter<Extended>(motion::ConstantVelocity(2.0), Position{}, 1e-13);
}
TEST(UnscentedFilter, IsTheKalmanFilterOnLinearModels) {
  is_the_dense_filter<Unscented>(motion::ConstantVelocity(2.0), sensors::Mounted<Position>(kPlace), 1e-12);
}

TEST(KalmanFilter, IsTheInformationForm) {
  motion::ConstantVelocity model;
  RandomStream stream({.seed = 12});
  for (int i = 0; i < 20; ++i) {
    linear::Gaussian<4> state{motion::drawn_state<motion::ConstantVelocity>(stream, i),
                              motion::drawn_covariance<4>(stream, 1.0)};
    const sensors::Measurement<2> z{{1.0, 2.0}, motion::drawn_covariance<2>(stream, 0.5)};
    linear::Matrix<4> information = inverse(state.p);
    linear::Vector<4> vector = information * state.x;
    const linear::Matrix<2> r_inverse = inverse(z.r);
    information.topLeftCorner<2, 2>() += r_inverse;
    vector.head<2>() += r_inverse * z.z;
    Kalman{}.update(model, Position{}, z, state);
    const linear::Matrix<4> p = inverse(information);
    EXPECT_LT((motion::apart<4, 4>(state.p, p)), 1e-11);
    EXPECT_LT((motion::apart<4, 1>(state.x, p * vector)), 1e-10);
  }
}

// Headings just below and just above half a turn are neighbours, for points and for their mean.
TEST(UnscentedFilter, HeadingsAverageAsAngles) {
  const motion::Ctrv model(0.01, 0.01);
  linear::Gaussian<5> state;
  state.x << 10.0, 0.0, 3.13, 5.0, 0.1;
  state.p = linear::Vector<5>(0.01, 0.01, 0.04, 0.01, 0.01).asDiagonal();
  linear::Gaussian<5> turned = state;
  turned.x(2) = 0.13;  // the same, except for a turn of three radians
  Unscented{}.predict(model, state, 0.5);
  Unscented{}.predict(model, turned, 0.5);
  EXPECT_NEAR(motion::to_half_turn(state.x(2) - turned.x(2)), 3.0, 1e-13);
  EXPECT_NEAR(state.p(2, 2), turned.p(2, 2), 1e-13);
  sensors::Measurement<3> z{{state.x(0), state.x(1), 0.05}, 0.01 * linear::Matrix<3>::Identity()};
  const Innovation<3> asked = Unscented{}.innovate(model, PositionHeading{}, z, state);
  const Innovation<3> innovation = Unscented{}.update(model, PositionHeading{}, z, state);
  expect_same<3>(asked, innovation);
  EXPECT_LT(std::abs(innovation.nu(2)), 0.5 * std::numbers::pi);
  EXPECT_LT(state.p(2, 2), 0.01);
}
// The mean of a bearing and range over a wide sector pulls inwards: E[r cos b] = r exp(-s^2 / 2).
TEST(UnscentedFilter, HasTheMeanOfABend) {
  const motion::Ctrv model(0.0, 0.0);
  linear::Gaussian<5> start;
  start.x << 0.0, 0.0, 0.0, 10.0, 0.0;
  start.p(2, 2) = 0.09;
  linear::Gaussian<5> state = start, extended = start;
  Unscented{}.predict(model, state, 1.0);
  Extended{}.predict(model, extended, 1.0);
  const double exact = 10.0 * std::exp(-0.045);
  EXPECT_NEAR(state.x(0), exact, 0.02);
  EXPECT_EQ(extended.x(0), 10.0) << "the first order does not know";
  const double variance = 50.0 * std::pow(1.0 - std::exp(-0.09), 2);
  EXPECT_GT(state.p(0, 0), variance) << "the default errs to the safe side";
  EXPECT_LT(state.p(0, 0), 2.5 * variance);
  EXPECT_EQ(extended.p(0, 0), 0.0);
  linear::Gaussian<5> near = start;
  Unscented{.alpha = 0.1, .beta = 2.0}.predict(model, near, 1.0);
  EXPECT_NEAR(near.x(0), exact, 0.02);
  EXPECT_NEAR(near.p(0, 0), variance, 0.05);
}

template <class F, class S>
void refuses(const F& filter, const S& sensor,
             linear::Gaussian<4> state = {linear::Vector<4>::Zero(), linear::Matrix<4>::Identity()}) {
  const linear::Gaussian<4> before = state;
  EXPECT_FALSE(filter.update(motion::ConstantVelocity{}, sensor, {}, state).used);
  EXPECT_TRUE((motion::same<4, 1>(state.x, before.x)));
  EXPECT_TRUE((motion::same<4, 4>(state.p, before.p)));
}
TEST(Filters, DoNotUseWhatTheyCannotSee) {
  refuses(Extended{}, RangeBearingRate{});  // at the sensor
  refuses(Unscented{}, PositionHeading{});  // standing: no course
}
// At 0.5 m/s it has a course. A sigma point two sigmas off, at 0.09 m/s, has none.
TEST(UnscentedFilter, DoesNotUseWhatOneOfItsPointsCannotSee) {
  linear::Gaussian<4> slow{{10.0, 2.0, 0.5, 0.0},
                           linear::Matrix<4>(linear::Vector<4>(0.01, 0.01, 0.205 * 0.205, 0.01).asDiagonal())};
  refuses(Unscented{}, PositionHeading{}, slow);
  const sensors::Measurement<3> z{{10.0, 2.0, 0.1}, 0.01 * linear::Matrix<3>::Identity()};
  linear::Gaussian<4> linearised = slow;
  EXPECT_TRUE(Extended{}.update(motion::ConstantVelocity{}, PositionHeading{}, z, linearised).used);
  slow.p(2, 2) = 0.195 * 0.195;  // 0.11 m/s
  EXPECT_TRUE(Unscented{}.update(motion::ConstantVelocity{}, PositionHeading{}, z, slow).used);
}

// One drive with two biased sensors, against the state augmented by all biases, whose gain has zero
// rows for the biases.
TEST(ConsiderFilter, IsTheAugmentedFilterWithoutTheBiasesGain) {
  using M = motion::ConstantVelocity;
  constexpr int kB = 7, kA = 4 + kB;
  const M model(0.5);
  const sensors::Systematic<Position> laser{{}, {0.1, 0.0}, 0.01};
  const sensors::Systematic<RangeBearingRate> radar{{}, {0.2, 0.01, 0.0}, -0.02};
  RandomStream stream({.seed = 13});
  Considered<4, kB> considered;
  considered.state.x << 30.0, 8.0, 5.0, 2.0;
  considered.state.p = motion::drawn_covariance<4>(stream, 1.0);
  const Consider<kB> filter{.bias = motion::drawn_covariance<kB>(stream, 0.05)};
  linear::Matrix<kA> p = linear::Matrix<kA>::Zero();
  p.topLeftCorner<4, 4>() = considered.state.p;
  p.bottomRightCorner<kB, kB>() = filter.bias;
  linear::Vector<4> x = considered.state.x;

  const auto one = [&]<int First>(const auto& sensor) {
    using S = std::decay_t<decltype(sensor)>;
    constexpr int kM = S::kDimension;
    filter.predict(model, considered, 0.1);
    linear::Matrix<kA> f = linear::Matrix<kA>::Identity();
    f.topLeftCorner<4, 4>() = model.step(0.1).f;
    p = motion::sandwich<kA, kA>(f, p);
    p.topLeftCorner<4, 4>() += model.step(0.1).q;
    x = model.move(x, 0.1);

    sensors::Measurement<kM> z;
    const motion::Kinematics k = M::kinematics<motion::kWithVelocity>(x);
    z.r = motion::drawn_covariance<kM>(stream, 0.05);
    z.z = motion::drawn<kM>(sensor.expected(k), z.r, stream);
    linear::Matrix<kM, kA> h = linear::Matrix<kM, kA>::Zero();
    h.template leftCols<4>() = sensor.jacobian(k);
    h.template middleCols<S::kBiases>(4 + First) = sensor.bias_jacobian(k);
    const linear::Matrix<kM, kA> hp = motion::times<kM, kA, kA>(h, p);
    const linear::Matrix<kM> s = motion::sandwich<kM, kA>(h, p) + z.r;
    linear::Matrix<kA, kM> gain = Ldl<kM>(s).template divide<kA>(hp.transpose());
    gain.template bottomRows<kB>().setZero();
    const linear::Vector<kM> nu = sensor.residual(z.z, sensor.expected(k));
    x += motion::times<4, kM, 1>(linear::Matrix<4, kM>(gain.template topRows<4>()), nu);
    linear::Matrix<kA> a = linear::Matrix<kA>::Identity();
    motion::add_scaled<kA, kA>(a, -1.0, motion::times<kA, kM, kA>(gain, h));
    p = motion::sandwich<kA, kA>(a, p);
    motion::add_scaled<kA, kA>(p, 1.0, motion::sandwich<kA, kM>(gain, z.r));

    const Innovation<kM> asked = filter.template innovate<First>(model, sensor, z, considered);
    const Innovation<kM> innovation = filter.template update<First>(model, sensor, z, considered);
    EXPECT_TRUE((motion::same<kM, kM>(asked.s, innovation.s))) << "what a gate asks is what an update finds";
    EXPECT_EQ(asked.nis, innovation.nis);
    EXPECT_LT((motion::apart<kM, kM>(innovation.s, s)), 1e-12);
  };
  for (int k = 0; k < 30; ++k) {
    one.template operator()<0>(laser);
    one.template operator()<3>(radar);
    EXPECT_LT((motion::apart<4, 1>(considered.state.x, x)), 1e-11);
    EXPECT_LT((motion::apart<4, 4>(considered.state.p, linear::Matrix<4>(p.topLeftCorner<4, 4>()))), 1e-11);
    EXPECT_LT((motion::apart<4, kB>(considered.cross, linear::Matrix<4, kB>(p.topRightCorner<4, kB>()))), 1e-11);
    EXPECT_LT((motion::apart<kB, kB>(filter.bias, linear::Matrix<kB>(p.bottomRightCorner<kB, kB>()))), 1e-15)
        << "never learned";
  }
}

TEST(Filters, DoNotAllocate) {
  RandomStream stream({.seed = 14});
  linear::Gaussian<6> state{motion::drawn_state<motion::Ctra>(stream, 1), motion::drawn_covariance<6>(stream, 0.3)};
  linear::Gaussian<4> linear{motion::drawn_state<motion::ConstantVelocity>(stream, 1),
                             motion::drawn_covariance<4>(stream, 0.3)};
  const motion::Ctra model;
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 10; ++i) {
    Extended{}.predict(model, state, 0.1);
    Extended{}.update(model, sensors::Mounted<RangeBearingRate>(kPlace), {}, state);
    Unscented{}.predict(motion::ConstantVelocity{}, linear, 0.1);
    Unscented{}.update(motion::ConstantVelocity{}, sensors::Mounted<Position>(kPlace), {}, linear);
    Kalman{}.predict(motion::ConstantVelocity{}, linear, 0.1);
    Kalman{}.update(motion::ConstantVelocity{}, Position{}, {}, linear);
  }
  EXPECT_EQ(support::allocations() - before, 0);
}

}  // namespace
}  // namespace ttf::fusion::filters
