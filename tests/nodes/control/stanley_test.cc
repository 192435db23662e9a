#include "nodes/control/stanley.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ttf::nodes::control {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// PythonRobotics, stanley_control.py.
constexpr StanleyGains kPythonRobotics{0.5, 0.0, 0.0, 0.0, 30.0 * kDegree};

StanleyInput seen(double direction_error, double offset, double speed) {
  StanleyInput input;
  input.direction_error = direction_error;
  input.offset = offset;
  input.speed = speed;
  return input;
}

TEST(Stanley, IsPythonRoboticsFormWithoutTheOtherTerms) {
  EXPECT_DOUBLE_EQ(stanley_steering(kPythonRobotics, seen(0.1, 1.0, 5.0)), 0.1 + std::atan2(0.5, 5.0));
  EXPECT_DOUBLE_EQ(stanley_steering(kPythonRobotics, seen(0.1, -1.0, 5.0)), 0.1 - std::atan2(0.5, 5.0));
  EXPECT_DOUBLE_EQ(stanley_steering(kPythonRobotics, seen(0.0, 0.01, 0.0)), 30.0 * kDegree) << "a vehicle that stands";
  EXPECT_NEAR(stanley_steering(kPythonRobotics, seen(2.0 * std::numbers::pi + 0.1, 0.0, 5.0)), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(stanley_steering(kPythonRobotics, seen(-1.0, 0.0, 5.0)), -30.0 * kDegree);
}

TEST(Stanley, HasTheDampingTerms) {
  StanleyInput input = seen(0.05, 0.4, 9.0);
  input.yaw_rate = 0.3;
  input.path_yaw_rate = 0.1;
  input.steering_before = 0.02;
  input.steering_now = 0.05;
  input.steady_slip = 0.01;
  EXPECT_DOUBLE_EQ(stanley_steering({}, input), 0.05 + 0.01 + std::atan(0.1) - 0.02 - 0.003);
  EXPECT_NEAR(StanleyGains{}.largest_rad, 35.0 * kDegree, 1e-10);
}

// A kinematic vehicle on a straight path, 2 m off: the front axle's offset obeys e' = -v sin(atan(k e / v)).
TEST(Stanley, OffsetFadesAsItsPaperSays) {
  constexpr double speed = 5.0, wheelbase = 2.9, dt = 1e-4;
  double y = -1.0, heading = 0.0, expected = 1.0;  // y: the front axle
  const StanleyGains gains{0.5, 0.0, 0.0, 0.0, 1.0};
  for (int step = 0; step < 80000; ++step) {
    const double steering = stanley_steering(gains, seen(-heading, -y, speed));
    y += dt * speed * std::sin(heading + steering);
    heading += dt * speed / wheelbase * std::sin(steering);
    expected -= dt * speed * std::sin(std::atan2(0.5 * expected, speed));
  }
  EXPECT_NEAR(-y, expected, 1e-4);
  EXPECT_LT(expected, 0.03);
}

// Linear tyres on a circle to the left: with the steady slip, the vehicle has the path's curvature without offset.
TEST(Stanley, SteadySlipKeepsTheCircle) {
  const AxleLoad load;
  constexpr double speed = 15.0, yaw_rate = 0.2, rear_stiffness = 22e3;
  const double wheelbase = load.front_axle + load.rear_axle, force = load.mass * speed * yaw_rate;
  const double front_slip = force * load.rear_axle / wheelbase / load.front_stiffness;
  const double rear_slip = force * load.front_axle / wheelbase / rear_stiffness;
  // The velocity of the axles, less the heading, for small angles.
  const double at_rear = -rear_slip, at_front = at_rear + wheelbase * yaw_rate / speed;
  StanleyInput input = seen(at_front, 0.0, speed);  // the front axle's velocity is along the path
  input.yaw_rate = input.path_yaw_rate = yaw_rate;
  input.steady_slip = steady_slip(load, speed, yaw_rate);
  EXPECT_NEAR(input.steady_slip, front_slip, 1e-12);
  EXPECT_NEAR(stanley_steering({}, input), front_slip + at_front, 1e-12);
}

}  // namespace
}  // namespace ttf::nodes::control
