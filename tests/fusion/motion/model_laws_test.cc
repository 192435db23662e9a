// The laws of motion models (fusion/motion/motion_model.h), for every model and drawn states. Turn rates
// include those near zero. Also conversions between layouts.
#include "fusion/motion/conversion.h"
#include "tests/fusion/motion/drawn.h"

namespace ttf::fusion::motion {
namespace {

constexpr int kDraws = 300;

template <class M> class MotionLaws : public testing::Test {
 protected:
  RandomStream stream{{.seed = 1}};
  M model;
};
TYPED_TEST_SUITE(MotionLaws, AllMotions);

TYPED_TEST(MotionLaws, OneStepIsTwoSteps) {
  using M = TypeParam;
  for (int i = 0; i < kDraws; ++i) {
    const auto x = drawn_state<M>(this->stream, i);
    const double a = this->stream.uniform(0.0, 1.0), b = this->stream.uniform(0.0, 1.0);
    const linear::Vector<M::kStates> at_once = this->model.move(x, a + b);
    const linear::Vector<M::kStates> halting = this->model.move(this->model.move(x, a), b);
    const linear::Vector<M::kStates> difference = M::difference(at_once, halting);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-12) << "x = " << x.transpose();
  }
}

TYPED_TEST(MotionLaws, JacobianIsTheDerivative) {
  using M = TypeParam;
  constexpr int kN = M::kStates;
  for (int i = 0; i < kDraws; ++i) {
    const auto x = drawn_state<M>(this->stream, i);
    const double dt = i % 5 == 0 ? 1.0 : this->stream.uniform(0.0, 1.5);
    const linear::Matrix<kN> numerical = numerical_jacobian<kN, kN>(
        [&](const linear::Vector<kN>& at) { return this->model.move(at, dt); }, x, M::difference);
    EXPECT_LT((apart<kN, kN>(this->model.jacobian(x, dt), numerical)), 2e-9)
        << "x = " << x.transpose() << ", dt = " << dt;
  }
}

// The components driven by white noise: the last of each axis, or turn rate and the last but one.
template <class M> std::array<int, 2> driven() {
  if constexpr (M::kCartesian)
    return {M::kStates - 2, M::kStates - 1};
  else
    return {4, M::kStates == 6 ? 5 : 3};
}

// The noise of 400 steps, each added at the middle of its step: errors of (dt / 400)^2.
TYPED_TEST(MotionLaws, NoiseIsTheSumOfManySmallSteps) {
  using M = TypeParam;
  constexpr int kN = M::kStates, kSteps = 400;
  for (int i = 0; i < 30; ++i) {
    auto x = drawn_state<M>(this->stream, i);
    if constexpr (!M::kCartesian) x(4) = std::clamp(x(4), -1.0, 1.0);  // |w dt| <= 0.5
    const double dt = this->stream.uniform(0.02, 0.5), h = dt / kSteps;
    linear::Matrix<kN> sum = linear::Matrix<kN>::Zero();
    linear::Vector<kN> at = x;
    for (int k = 0; k < kSteps; ++k) {
      sum = sandwich<kN, kN>(this->model.jacobian(at, h), sum);
      const linear::Matrix<kN> rest = this->model.jacobian(this->model.move(at, 0.5 * h), 0.5 * h);
      for (const int which : driven<M>()) add_outer<kN>(sum, h, rest.col(which));  // spectral densities of 1
      at = this->model.move(at, h);
    }
    const linear::Matrix<kN> q = this->model.noise(x, dt);
    for (int r = 0; r < kN; ++r)
      for (int c = 0; c < kN; ++c)
        EXPECT_NEAR(q(r, c), sum(r, c), 2e-5 * std::sqrt(sum(r, r) * sum(c, c))) << r << c << ", x = " << x.transpose();
  }
}

// Linear: two steps' noise is one step's, exactly.
TEST(IntegratorChain, NoiseOfTwoSteps) {
  const motion::ConstantAcceleration model(0.7);
  const linear::LinearStep<6> a = model.step(0.3), b = model.step(0.45), whole = model.step(0.75);
  const linear::Matrix<6> joined = sandwich<6, 6>(b.f, a.q) + b.q;
  EXPECT_LT((apart<6, 6>(joined, whole.q)), 1e-15);
  EXPECT_NEAR(whole.q(0, 0), 0.7 * std::pow(0.75, 5) / 20.0, 1e-15);
  EXPECT_NEAR(whole.q(0, 2), 0.7 * std::pow(0.75, 4) / 8.0, 1e-15);
  EXPECT_NEAR(whole.q(1, 5), 0.7 * std::pow(0.75, 3) / 6.0, 1e-15);
}

// The way in place is the product of matrices.
template <class M> void advance_is_the_product(M model) {
  constexpr int kN = M::kStates;
  RandomStream stream({.seed = 2});
  for (int i = 0; i < 50; ++i) {
    linear::Gaussian<kN> state{drawn_state<M>(stream, i), drawn_covariance<kN>(stream, 3.0)};
    const double dt = stream.uniform(0.0, 2.0);
    const linear::LinearStep<kN> step = model.step(dt);
    const linear::Matrix<kN> p = sandwich<kN, kN>(step.f, state.p) + step.q;
    const linear::Vector<kN> x = times<kN, kN, 1>(step.f, state.x);
    model.advance(state, dt);
    EXPECT_LT((apart<kN, kN>(state.p, p)), 1e-14);
    EXPECT_LT((apart<kN, 1>(state.x, x)), 1e-14);
    EXPECT_TRUE(symmetric<kN>(state.p));
  }
}
TEST(IntegratorChain, AdvanceIsTheProduct) {
  advance_is_the_product(motion::ConstantVelocity(0.7));
  advance_is_the_product(motion::ConstantVelocity(0.7, 0.02));
  advance_is_the_product(motion::ConstantAcceleration(0.7));
}

TEST(IntegratorChain, AxesHaveTheirOwnNoise) {
  const linear::Vector<6> anywhere = linear::Vector<6>::Zero();
  const linear::Matrix<6> both = motion::ConstantAcceleration(0.7, 0.02).noise(anywhere, 0.3),
                          along = motion::ConstantAcceleration(0.7).noise(anywhere, 0.3),
                          across = motion::ConstantAcceleration(0.02).noise(anywhere, 0.3);
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      EXPECT_EQ(both(i, j), (i + j) % 2 == 1 ? 0.0 : i % 2 == 0 ? along(i, j) : across(i, j));
}

// Against quadrature with 2000 midpoints (error u^2 / 1e8), and across the switch of formulas.
TEST(TurnMoments, AreTheIntegrals) {
  for (const double u : {0.0, 1e-9, 0.01, -0.5, 0.999, 1.001, -2.0, 6.0}) {
    const motion::TurnMoments m = motion::turn_moments(u);
    for (std::size_t k = 0; k < 3; ++k) {
      double c = 0.0, s = 0.0;
      constexpr int kPoints = 2000;
      for (int i = 0; i < kPoints; ++i) {
        const double t = (i + 0.5) / kPoints;
        c += std::pow(t, static_cast<double>(k)) * std::cos(u * t) / kPoints;
        s += std::pow(t, static_cast<double>(k)) * std::sin(u * t) / kPoints;
      }
      EXPECT_NEAR(m.c[k], c, 1e-6) << u;
      EXPECT_NEAR(m.s[k], s, 1e-6) << u;
    }
  }
}
TEST(TurnMoments, AreContinuousWhereTheSeriesEnds) {
  for (const double side : {-1.0, 1.0}) {
    const motion::TurnMoments in = motion::turn_moments(side * std::nextafter(1.0, 0.0));
    const motion::TurnMoments out = motion::turn_moments(side);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(in.c[k], out.c[k], 1e-15);
      EXPECT_NEAR(in.s[k], out.s[k], 1e-15);
    }
  }
}

// Without a turn a polar model drives like the Cartesian one.
TEST(CoordinatedTurn, StraightOnIsConstantAcceleration) {
  linear::Vector<6> x;
  x << 3.0, -2.0, 0.4, 7.0, 0.0, 1.5;
  const linear::Vector<6> moved = motion::Ctra().move(x, 2.0);
  const double way = 7.0 * 2.0 + 0.5 * 1.5 * 4.0;
  EXPECT_NEAR(moved(0), 3.0 + way * std::cos(0.4), 1e-14);
  EXPECT_NEAR(moved(1), -2.0 + way * std::sin(0.4), 1e-14);
  EXPECT_EQ(moved(3), 10.0);
}
// A quarter of a circle of 20 m.
TEST(CoordinatedTurn, DrivesAroundACircle) {
  linear::Vector<5> x;
  x << 0.0, 0.0, 0.0, 10.0, 0.5;
  const linear::Vector<5> moved = motion::Ctrv().move(x, std::numbers::pi);
  EXPECT_NEAR(moved(0), 20.0, 1e-13);
  EXPECT_NEAR(moved(1), 20.0, 1e-13);
  EXPECT_NEAR(moved(2), 0.5 * std::numbers::pi, 1e-15);
}

// The converted uncertainty of one component is the derivative of the converted mean.
template <class From, class To> void conversion_is_first_order() {
  constexpr int kFrom = From::kStates, kTo = To::kStates;
  RandomStream stream({.seed = 3});
  linear::Gaussian<kTo> own{linear::Vector<kTo>::Constant(0.25), 2.0 * linear::Matrix<kTo>::Identity()};
  constexpr int kKnown = From::kCartesian && kFrom == 4 ? 4 : kTo;
  for (int draw = 0; draw < 60; ++draw) {
    linear::Gaussian<kFrom> from{.x = drawn_state<From>(stream, draw)};
    if constexpr (!From::kCartesian)
      from.x(3) = stream.uniform(3.0, 20.0);
    else if (from.x.template segment<2>(2).norm() < 2.0)
      continue;
    const linear::Matrix<kTo, kFrom> j = numerical_jacobian<kTo, kFrom>(
        [&](const linear::Vector<kFrom>& at) {
          return motion::converted<From, To>({at, from.p}, own).x;
        },
        from.x, To::difference);
    for (int i = 0; i < kFrom; ++i) {
      from.p.setZero();
      from.p(i, i) = 1.0;
      const linear::Gaussian<kTo> to = motion::converted<From, To>(from, own);
      for (int r = 0; r < kKnown; ++r)
        for (int c = 0; c < kKnown; ++c)
          EXPECT_NEAR(to.p(r, c), j(r, i) * j(c, i), 1e-7 * (1.0 + std::abs(to.p(r, c)))) << i << r << c;
      for (int r = kKnown; r < kTo; ++r) {
        EXPECT_EQ(to.x(r), own.x(r)) << "what is not known stays";
        for (int c = 0; c < kTo; ++c) EXPECT_EQ(to.p(r, c), r == c ? 2.0 : 0.0);
      }
    }
  }
}
TEST(Conversion, IsFirstOrder) {
  conversion_is_first_order<motion::Ctra, motion::ConstantAcceleration>();
  conversion_is_first_order<motion::ConstantAcceleration, motion::Ctra>();
  conversion_is_first_order<motion::ConstantVelocity, motion::Ctra>();
}
TEST(Conversion, ThereAndBackIsTheSame) {
  using motion::ConstantAcceleration, motion::Ctra;
  RandomStream stream({.seed = 4});
  for (int draw = 0; draw < 60; ++draw) {
    linear::Gaussian<6> from{drawn_state<Ctra>(stream, draw), drawn_covariance<6>(stream, 0.3)};
    from.x(3) = (draw % 2 == 0 ? 1.0 : -1.0) * stream.uniform(2.0, 20.0);  // reversing, too
    const linear::Gaussian<6> there = motion::converted<Ctra, ConstantAcceleration>(from, {});
    const linear::Gaussian<6> back = motion::converted<ConstantAcceleration, Ctra>(there, from);
    EXPECT_LT(Ctra::difference(back.x, from.x).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((apart<6, 6>(back.p, from.p)), 1e-11);
  }
}
TEST(Conversion, AStandingObjectKeepsItsHeading) {
  linear::Gaussian<4> standing;
  standing.x << 5.0, 6.0, 0.01, 0.0;
  standing.p.setIdentity();
  linear::Gaussian<5> own;
  own.x << 0.0, 0.0, 1.2, 0.02, 0.3;
  own.p = 4.0 * linear::Matrix<5>::Identity();
  const linear::Gaussian<5> to = motion::converted<motion::ConstantVelocity, motion::Ctrv>(standing, own);
  EXPECT_EQ(to.x(0), 5.0);
  for (int i = 2; i < 5; ++i) EXPECT_EQ(to.x(i), own.x(i));
  EXPECT_EQ(to.p(2, 2), 4.0);
  EXPECT_EQ(to.p(0, 0), 1.0);
}

}  // namespace
}  // namespace ttf::fusion::motion
