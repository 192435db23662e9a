// The laws of sensor models (fusion/sensors/sensor_model.h), for every sensor: plain, mounted, and with
// systematic errors. Also the chain rule with every motion model.
#include "fusion/filters/linearise.h"
#include "fusion/sensors/mounted.h"
#include "fusion/sensors/position.h"
#include "fusion/sensors/range_bearing_rate.h"
#include "tests/fusion/motion/drawn.h"
#include "tests/fusion/sensors/position_heading.h"
#include "tests/fusion/sensors/systematic.h"

namespace ttf::fusion::sensors {
namespace {

motion::Kinematics from_numbers(const linear::Vector<5>& n) { return {n.head<2>(), n.segment<2>(2), n(4), true}; }

linear::Vector<5> drawn_kinematics(RandomStream& stream) {
  linear::Vector<5> n;
  for (int i = 0; i < 4; ++i) n(i) = stream.uniform(-20.0, 20.0);
  n(4) = stream.uniform(-3.0, 3.0);
  return n;
}

const Mounting kOnAVehicle = carried({.position = {3.5, -0.4}, .yaw = 0.3}, {8.0, 0.5}, 0.2);

// Three ways of having each sensor.
template <class S> struct Plain {
  using Sensor = S;
  static Sensor make() { return {}; }
};
template <class S> struct OnAVehicle {
  using Sensor = Mounted<S>;
  static Sensor make() { return Sensor(kOnAVehicle); }
};
template <class S> struct Wrong {
  using Sensor = Mounted<Systematic<S>>;
  static Sensor make() { return with({{}, linear::Vector<S::kDimension>::Constant(0.1), -0.03}); }
  static Sensor with(const Systematic<S>& sensor) { return Sensor(kOnAVehicle, sensor); }
};

template <class How> class SensorLaws : public testing::Test {};
using AllSensors = testing::Types<Plain<Position>, Plain<PositionHeading>, Plain<RangeBearing>, Plain<RangeBearingRate>,
                                  OnAVehicle<Position>, OnAVehicle<PositionHeading>, OnAVehicle<RangeBearingRate>,
                                  Wrong<PositionHeading>, Wrong<RangeBearingRate>>;
TYPED_TEST_SUITE(SensorLaws, AllSensors);

TYPED_TEST(SensorLaws, JacobianIsTheDerivative) {
  using S = typename TypeParam::Sensor;
  constexpr int kM = S::kDimension;
  const S sensor = TypeParam::make();
  RandomStream stream({.seed = 5});
  for (int i = 0; i < 200; ++i) {
    const linear::Vector<5> at = drawn_kinematics(stream);
    if (!sensor.sees(from_numbers(at)) || at.head<2>().norm() < 8.0) continue;  // near, the difference is not small
    const linear::Matrix<kM, 5> numerical =
        motion::numerical_jacobian<kM, 5>([&](const linear::Vector<5>& n) { return sensor.expected(from_numbers(n)); },
                                          at, [&](const auto& a, const auto& b) { return sensor.residual(a, b); });
    linear::Matrix<kM, 5> h = linear::Matrix<kM, 5>::Zero();
    h.template leftCols<S::kParts>() = sensor.jacobian(from_numbers(at));
    EXPECT_LT((motion::apart<kM, 5>(h, numerical)), 1e-7) << at.transpose();
  }
}
TYPED_TEST(SensorLaws, NothingIsLeftOfWhatWasExpected) {
  const auto sensor = TypeParam::make();
  RandomStream stream({.seed = 6});
  for (int i = 0; i < 50; ++i) {
    const auto z = sensor.expected(from_numbers(drawn_kinematics(stream)));
    EXPECT_EQ(sensor.residual(z, z).norm(), 0.0);
  }
}

TEST(Residual, BelongsToTheNearestTurn) {
  EXPECT_NEAR(RangeBearing{}.residual({5.0, 3.1}, {5.0, -3.1})(1), 6.2 - 2.0 * std::numbers::pi, 1e-15);
  EXPECT_NEAR(RangeBearingRate{}.residual({5.0, -3.1, 0.0}, {5.0, 3.1, 0.0})(1), 2.0 * std::numbers::pi - 6.2, 1e-15);
  EXPECT_NEAR(PositionHeading{}.residual({0.0, 0.0, 3.0}, {0.0, 0.0, 0.1})(2), 2.9 - std::numbers::pi, 1e-15)
      << "front and back look alike";
}
TEST(Sees, NotAtRangeZeroNorWhatHasNoHeading) {
  EXPECT_FALSE(RangeBearing{}.sees({.position = {1e-4, 0.0}}));
  EXPECT_TRUE(RangeBearing{}.sees({.position = {1e-2, 0.0}}));
  const Mounted<RangeBearingRate> radar({.position = {3.0, 0.0}});
  EXPECT_FALSE(radar.sees({.position = {3.0, 0.0}})) << "where the sensor is, not where the vehicle is";
  EXPECT_TRUE(radar.sees({}));
  EXPECT_FALSE(PositionHeading{}.sees({.has_heading = false}));
  EXPECT_TRUE(std::isfinite(RangeBearingRate{}.expected({})(2)));
}

// A radar looks left from 2 m ahead and 1 m left of the origin. The vehicle drives at 5 m/s.
TEST(MountedSensor, SeesFromItsPlace) {
  const Mounting place = carried({.position = {2.0, 1.0}, .yaw = 0.5 * std::numbers::pi}, {5.0, 0.0}, 0.0);
  const motion::Kinematics ahead_of_it{{2.0, 11.0}, {5.0, 3.0}, 0.0, true};
  const linear::Vector<3> z = Mounted<RangeBearingRate>(place).expected(ahead_of_it);
  EXPECT_NEAR(z(0), 10.0, 1e-14);
  EXPECT_NEAR(z(1), 0.0, 1e-14);
  EXPECT_NEAR(z(2), 3.0, 1e-14) << "what drives along has no speed of its own";
  const linear::Vector<2> as_it_turns = carried({.position = {2.0, 1.0}}, {5.0, 0.0}, 0.1).velocity;
  EXPECT_NEAR(as_it_turns.x(), 4.9, 1e-15);
  EXPECT_NEAR(as_it_turns.y(), 0.2, 1e-15);
}

TEST(SystematicErrors, ShiftByVelocityTimesTimeBias) {
  const Systematic<Position> laser{{}, {0.2, -0.1}, 0.05};
  const linear::Vector<2> z = laser.expected({{10.0, 5.0}, {20.0, -4.0}, 0.0, true});
  EXPECT_NEAR(z(0), 10.0 + 1.0 + 0.2, 1e-14);
  EXPECT_NEAR(z(1), 5.0 - 0.2 - 0.1, 1e-14);
}
template <class S> void bias_jacobian_is_the_derivative() {
  constexpr int kB = Mounted<Systematic<S>>::kBiases, kM = S::kDimension;
  RandomStream stream({.seed = 7});
  for (int i = 0; i < 50; ++i) {
    const linear::Vector<5> at = drawn_kinematics(stream);
    if (at.head<2>().norm() < 8.0) continue;
    linear::Vector<kB> biases;
    for (int k = 0; k < kB; ++k) biases(k) = stream.uniform(-0.05, 0.05);
    const auto with = [&](const linear::Vector<kB>& b) { return Wrong<S>::with({{}, b.template head<kM>(), b(kM)}); };
    const linear::Matrix<kM, kB> numerical = motion::numerical_jacobian<kM, kB>(
        [&](const linear::Vector<kB>& b) { return with(b).expected(from_numbers(at)); }, biases,
        [&](const auto& a, const auto& b) { return with(biases).residual(a, b); });
    EXPECT_LT((motion::apart<kM, kB>(with(biases).bias_jacobian(from_numbers(at)), numerical)), 1e-7);
  }
}
TEST(SystematicErrors, BiasJacobianIsTheDerivative) {
  bias_jacobian_is_the_derivative<Position>();
  bias_jacobian_is_the_derivative<RangeBearingRate>();
}

// The vehicle and its target drive alike: the target was always at the same place ahead.
template <class S> void late_stamps_do_not_matter() {
  const linear::Vector<2> velocity(22.0, 0.5);
  const Mounting place = carried({.position = {3.5, -0.4}, .yaw = 0.3}, velocity, 0.0);
  const Systematic<S> late{{}, linear::Vector<S::kDimension>::Zero(), 0.05};
  const motion::Kinematics followed{{30.0, 2.0}, velocity, 0.02, true};
  EXPECT_EQ(Mounted<Systematic<S>>(place, late).expected(followed), Mounted<S>(place).expected(followed));
  EXPECT_EQ((Mounted<Systematic<S>>(place, late).bias_jacobian(followed).col(S::kDimension).norm()), 0.0);
}
TEST(SystematicErrors, TimeBiasIsOfTheMotionRelativeToTheSensor) {
  late_stamps_do_not_matter<Position>();
  late_stamps_do_not_matter<PositionHeading>();
  late_stamps_do_not_matter<RangeBearingRate>();
  // A standing object comes nearer by the vehicle's way.
  const Mounted<Systematic<Position>> laser(carried({}, {20.0, 0.0}, 0.0), {{}, linear::Vector<2>::Zero(), 0.05});
  EXPECT_NEAR(laser.expected({.position = {30.0, 2.0}}).x(), 29.0, 1e-14);
  EXPECT_NEAR(laser.bias_jacobian({.position = {30.0, 2.0}})(0, 2), -20.0, 1e-14);
}

template <class S>
concept MayBeWrong = requires {
  typename Systematic<S>;
};
static_assert(MayBeWrong<RangeBearing> && !MayBeWrong<Mounted<RangeBearing>>);
static_assert(Biased<Mounted<Systematic<RangeBearing>>> && !Biased<Mounted<RangeBearing>>);

template <class M> class ChainRule : public testing::Test {
 protected:
  // The measurement matrix is the derivative by the leading components. The measurement does not depend on
  // the others.
  template <class S> void check(const S& sensor) {
    constexpr int kN = M::kStates, kM = S::kDimension, kC = motion::leading_columns(S::kParts);
    RandomStream stream({.seed = 8});
    for (int i = 0; i < 100; ++i) {
      const linear::Vector<kN> x = motion::drawn_state<M>(stream, i);
      const motion::Kinematics k = M::template kinematics<S::kParts>(x);
      if (k.position.norm() < 8.0 || std::hypot(x(2), x(3)) < 1.0) continue;
      const linear::Matrix<kM, kN> numerical = motion::numerical_jacobian<kM, kN>(
          [&](const linear::Vector<kN>& at) { return sensor.expected(M::template kinematics<S::kParts>(at)); }, x,
          [&](const auto& a, const auto& b) { return sensor.residual(a, b); });
      linear::Matrix<kM, kN> h = linear::Matrix<kM, kN>::Zero();
      h.template leftCols<kC>() = filters::measurement_matrix<M>(sensor, k, x);
      EXPECT_LT((motion::apart<kM, kN>(h, numerical)), 1e-7) << x.transpose();
    }
  }
};
TYPED_TEST_SUITE(ChainRule, motion::AllMotions);

TYPED_TEST(ChainRule, MeasurementMatrixIsTheDerivative) {
  this->check(RangeBearingRate{});
  this->check(Wrong<PositionHeading>::make());
}

}  // namespace
}  // namespace ttf::fusion::sensors
