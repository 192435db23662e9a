// The models against published derivatives and runs: those of CommonRoad's own tests (vehicle models, vehicle 1), which the
// ports of F1TENTH's simulator repeat. And against a second form of the equations, in forces.
#include "sim/world/vehicle/single_track.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ttf::sim::world::vehicle {
namespace {

constexpr double kGravity = 9.81;
const Command kPublished{0.15, 0.63 * kGravity};

// The published models change over at 0.5 m/s.
Parameters as_published() {
  Parameters vehicle;
  vehicle.kinematic_below = 0.5;
  return vehicle;
}

Motion driven(const Parameters& vehicle, Motion state, const Command& command, int steps, double dt) {
  for (int k = 0; k < steps; ++k) state = stepped(vehicle, state, command, dt);
  return state;
}

double apart(const Motion& a, const Motion& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(SingleTrack, HasThePublishedKinematicRates) {
  const RearAxle state{3.9579422297936526, 0.0391650102771405, 0.0378491427211811, 16.3546957860883566,
                       0.0294717351052816};
  const RearAxle rate = rates(Parameters{}, state, kPublished);
  EXPECT_NEAR(rate.x, 16.3475935934250209, 1e-9);
  EXPECT_NEAR(rate.y, 0.4819314886013121, 1e-9);
  EXPECT_NEAR(rate.steering, 0.15, 1e-9);
  EXPECT_NEAR(rate.speed, 5.1464424102339752, 1e-9);
  EXPECT_NEAR(rate.heading, 0.2401426578627629, 1e-9);
}

TEST(SingleTrack, HasThePublishedDynamicRates) {
  const Motion state{2.0233348142065677, 0.0041907137716636, 0.0197545248559617, 15.7216236334290116,
                     0.0025857914776859, 0.0529001056654038, 0.0033012170610298};
  const Motion rate = rates(Parameters{}, state, kPublished);
  EXPECT_NEAR(rate.x, 15.7213512030862397, 1e-9);
  EXPECT_NEAR(rate.y, 0.0925527979719355, 1e-9);
  EXPECT_NEAR(rate.steering, 0.15, 1e-9);
  EXPECT_NEAR(rate.speed, 5.3536773276413925, 1e-9);
  EXPECT_NEAR(rate.heading, 0.0529001056654038, 1e-9);
  EXPECT_NEAR(rate.yaw_rate, 0.6435589397748606, 1e-9);
  EXPECT_NEAR(rate.slip, 0.0313297971641291, 1e-9);
}

// Steering left and accelerating from rest, for a second.
TEST(SingleTrack, DrivesThePublishedWayFromRest) {
  const Parameters vehicle = as_published();
  RearAxle axle;
  for (int k = 0; k < 1000; ++k) {  // by Euler's steps, which suffice for a comparison to 1e-2
    const RearAxle rate = rates(vehicle, axle, kPublished);
    axle = {axle.x + 1e-3 * rate.x, axle.y + 1e-3 * rate.y, axle.steering + 1e-3 * rate.steering,
            axle.speed + 1e-3 * rate.speed, axle.heading + 1e-3 * rate.heading};
  }
  EXPECT_NEAR(axle.x, 3.0845676868494927, 1e-2);
  EXPECT_NEAR(axle.y, 0.1484249221523042, 1e-2);
  EXPECT_NEAR(axle.speed, 6.1803, 1e-2);
  EXPECT_NEAR(axle.heading, 0.1203664469224163, 1e-2);
  const Motion end = driven(vehicle, {}, kPublished, 500, kStep_s);
  EXPECT_NEAR(end.x, 3.0731976046859715, 1e-2);
  EXPECT_NEAR(end.y, 0.2869835398304389, 1e-2);
  EXPECT_NEAR(end.steering, 0.15, 1e-2);
  EXPECT_NEAR(end.speed, 6.1803, 1e-2);
  EXPECT_NEAR(end.heading, 0.1097747074946325, 1e-2);
  EXPECT_NEAR(end.yaw_rate, 0.3248268063223301, 1e-2);
  EXPECT_NEAR(end.slip, 0.0697547542798040, 1e-2);
}

TEST(SingleTrack, BrakesAsPublished) {
  const Motion end = driven(as_published(), {}, {0.0, -0.7 * kGravity}, 500, kStep_s);
  EXPECT_NEAR(end.x, -3.4335, 1e-2);
  EXPECT_NEAR(end.speed, -6.867, 1e-2);
  EXPECT_NEAR(end.y, 0.0, 1e-12);
}

// The second form: forces of linear tyres in the vehicle's axes, for velocities along them. Both are the same to the first
// order of the angles.
TEST(SingleTrack, AgreesWithTheEquationsInForces) {
  Parameters vehicle;
  vehicle.front_axle = 1.4, vehicle.rear_axle = 1.6;
  vehicle.mass = 2000.0, vehicle.yaw_inertia = 4000.0;
  const double front = 12e3, rear = 11e3;  // [N/rad], of one wheel
  const double load = vehicle.friction * vehicle.mass * kGravity / vehicle.wheelbase();
  vehicle.front_stiffness = 2.0 * front / (load * vehicle.rear_axle);
  vehicle.rear_stiffness = 2.0 * rear / (load * vehicle.front_axle);
  for (const double speed : {5.0, 12.0, 30.0})
    for (const double steering : {0.0, 1e-4})
      for (const double yaw_rate : {0.0, -1e-4})
        for (const double slip : {0.0, 1e-4}) {
          const Motion state{0, 0, steering, speed, 0, yaw_rate, slip};
          const double vx = speed * std::cos(slip), vy = speed * std::sin(slip);
          const double ff = front * (steering - std::atan((vy + vehicle.front_axle * yaw_rate) / vx)),
                       fr = -rear * std::atan((vy - vehicle.rear_axle * yaw_rate) / vx);
          const double vy_rate = -yaw_rate * vx + 2.0 / vehicle.mass * (ff * std::cos(steering) + fr);
          const double turning = 2.0 / vehicle.yaw_inertia * (vehicle.front_axle * ff - vehicle.rear_axle * fr);
          const Motion rate = rates(vehicle, state, {});
          EXPECT_NEAR(rate.yaw_rate, turning, 1e-10) << speed << ' ' << steering << ' ' << yaw_rate << ' ' << slip;
          EXPECT_NEAR(speed * rate.slip, vy_rate, 1e-10) << speed << ' ' << steering << ' ' << yaw_rate << ' ' << slip;
        }
}

// Steps of kStep against steps a tenth as long, for a swerve while accelerating.
TEST(SingleTrack, StepsAreShortEnough) {
  for (const double below : {0.5, 3.0}) {
    Parameters vehicle;
    vehicle.kinematic_below = below;
    Motion coarse = without_slip(vehicle, {0, 0, 0.05, below + 0.1, 0}), fine = coarse;
    for (int k = 0; k < 200; ++k) {
      const Command command{0.3 * std::cos(0.1 * k), 1.5};
      coarse = advanced(vehicle, coarse, command, 0.01);
      fine = driven(vehicle, fine, command, 50, 0.1 * kStep_s);
    }
    EXPECT_LT(apart(coarse, fine), below < 1.0 ? 1e-6 : 2e-9) << below;
    EXPECT_NEAR(coarse.yaw_rate, fine.yaw_rate, 1e-8) << below;
  }
}

// From 10 m/s to a standstill in a bend: the change to the kinematic model moves nothing by more than this.
TEST(SingleTrack, ChangesItsModelGently) {
  const Parameters vehicle;
  Motion state = without_slip(vehicle, {0, 0, 0.15, 10.0, 0});
  while (state.speed > 0.02) {
    const Motion next = stepped(vehicle, state, {0.0, -3.0}, kStep_s);
    EXPECT_LT(apart(next, state), 1.01 * state.speed * kStep_s + 1e-3) << state.speed;
    EXPECT_NEAR(next.yaw_rate, state.yaw_rate, state.speed < 5.0 ? 0.01 : 0.02) << state.speed;
    state = next;
  }
  EXPECT_NEAR(state.yaw_rate, 0.0, 0.002);
}

TEST(SingleTrack, KeepsItsLimits) {
  const Parameters v;
  EXPECT_EQ(limited(v, 0.0, 1.0, {9.0, 30.0}).steering_rate, 0.4);
  EXPECT_EQ(limited(v, 0.0, 1.0, {-9.0, 30.0}).acceleration, 11.5);
  EXPECT_EQ(limited(v, 1.066, 1.0, {0.1, 0.0}).steering_rate, 0.0);
  EXPECT_EQ(limited(v, 1.066, 1.0, {-0.1, 0.0}).steering_rate, -0.1);
  EXPECT_EQ(limited(v, -1.066, 1.0, {-0.1, 0.0}).steering_rate, 0.0);
  EXPECT_DOUBLE_EQ(limited(v, 0.0, 14.638, {0.0, 30.0}).acceleration, 5.75);
  EXPECT_EQ(limited(v, 0.0, 14.638, {0.0, -30.0}).acceleration, -11.5);
  EXPECT_EQ(limited(v, 0.0, 50.8, {0.0, 1.0}).acceleration, 0.0);
}

// In a steady turn, with tyres that understeer.
TEST(SingleTrack, SteersForAYawRate) {
  Parameters vehicle;
  vehicle.front_stiffness = 15.0;
  for (const double speed : {2.0, 8.0, 20.0}) {
    Motion state = without_slip(vehicle, {0, 0, 0, speed, 0});
    state.steering = steering_for(vehicle, 0.2, state);
    state = advanced(vehicle, without_slip(vehicle, rear_axle(vehicle, state)), {}, 3.0);
    EXPECT_NEAR(state.yaw_rate, 0.2, 5e-4) << speed;
  }
  EXPECT_EQ(steering_for(vehicle, 1.0, Motion{}), vehicle.largest_steering);
  EXPECT_EQ(steering_for(vehicle, 0.0, Motion{}), 0.0);
}

}  // namespace
}  // namespace ttf::sim::world::vehicle
