#include "sim/world/vehicle/single_track.h"

#include <algorithm>
#include <cmath>

namespace ttf::sim::world::vehicle {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2], as in the source

RearAxle plus(const RearAxle& s, double dt, const RearAxle& rate) {
  return {s.x + dt * rate.x, s.y + dt * rate.y, s.steering + dt * rate.steering, s.speed + dt * rate.speed,
          s.heading + dt * rate.heading};
}
Motion plus(const Motion& s, double dt, const Motion& rate) {
  return {s.x + dt * rate.x,
          s.y + dt * rate.y,
          s.steering + dt * rate.steering,
          s.speed + dt * rate.speed,
          s.heading + dt * rate.heading,
          s.yaw_rate + dt * rate.yaw_rate,
          s.slip + dt * rate.slip};
}

template <class State> State runge_kutta(const Parameters& vehicle, const State& s, const Command& command, double dt) {
  const State a = rates(vehicle, s, command), b = rates(vehicle, plus(s, 0.5 * dt, a), command),
              c = rates(vehicle, plus(s, 0.5 * dt, b), command), d = rates(vehicle, plus(s, dt, c), command);
  const double sixth = dt / 6.0;
  return plus(plus(plus(plus(s, sixth, a), 2.0 * sixth, b), 2.0 * sixth, c), sixth, d);
}

}  // namespace

Command limited(const Parameters& vehicle, double steering, double speed, const Command& command) {
  Command can;
  const bool at_stop = (steering <= -vehicle.largest_steering && command.steering_rate <= 0.0) ||
                       (steering >= vehicle.largest_steering && command.steering_rate >= 0.0);
  if (!at_stop)
    can.steering_rate =
        std::clamp(command.steering_rate, -vehicle.largest_steering_rate, vehicle.largest_steering_rate);
  const bool at_limit = (speed <= vehicle.slowest && command.acceleration <= 0.0) ||
                        (speed >= vehicle.fastest && command.acceleration >= 0.0);
  const double most = speed > vehicle.full_power_speed ? vehicle.largest_acceleration * vehicle.full_power_speed / speed
                                                       : vehicle.largest_acceleration;
  if (!at_limit) can.acceleration = std::clamp(command.acceleration, -vehicle.largest_acceleration, most);
  return can;
}

RearAxle rates(const Parameters& vehicle, const RearAxle& s, const Command& command) {
  const Command can = limited(vehicle, s.steering, s.speed, command);
  return {s.speed * std::cos(s.heading), s.speed * std::sin(s.heading), can.steering_rate, can.acceleration,
          s.speed / vehicle.wheelbase() * std::tan(s.steering)};
}

Motion rates(const Parameters& vehicle, const Motion& s, const Command& command) {
  const Command can = limited(vehicle, s.steering, s.speed, command);
  const double lf = vehicle.front_axle, lr = vehicle.rear_axle, l = vehicle.wheelbase();
  const double front = vehicle.front_stiffness * (kGravity * lr - can.acceleration * vehicle.height),
               rear = vehicle.rear_stiffness * (kGravity * lf + can.acceleration * vehicle.height);
  const double turning = vehicle.friction * vehicle.mass / (vehicle.yaw_inertia * l),
               slipping = vehicle.friction / (s.speed * l);
  return {s.speed * std::cos(s.heading + s.slip),
          s.speed * std::sin(s.heading + s.slip),
          can.steering_rate,
          can.acceleration,
          s.yaw_rate,
          turning * (-(lf * lf * front + lr * lr * rear) * s.yaw_rate / s.speed + (lr * rear - lf * front) * s.slip +
                     lf * front * s.steering),
          slipping * ((lr * rear - lf * front) * s.yaw_rate / s.speed - (rear + front) * s.slip + front * s.steering) -
              s.yaw_rate};
}

RearAxle rear_axle(const Parameters& vehicle, const Motion& s) {
  return {s.x - vehicle.rear_axle * std::cos(s.heading), s.y - vehicle.rear_axle * std::sin(s.heading), s.steering,
          s.speed * std::cos(s.slip), s.heading};
}

Motion without_slip(const Parameters& vehicle, const RearAxle& s) {
  const double slip = std::atan(vehicle.rear_axle / vehicle.wheelbase() * std::tan(s.steering));
  return {s.x + vehicle.rear_axle * std::cos(s.heading),
          s.y + vehicle.rear_axle * std::sin(s.heading),
          s.steering,
          s.speed / std::cos(slip),
          s.heading,
          s.speed / vehicle.wheelbase() * std::tan(s.steering),
          slip};
}

Motion stepped(const Parameters& vehicle, const Motion& state, const Command& command, double dt) {
  if (std::abs(state.speed) >= vehicle.kinematic_below) return runge_kutta(vehicle, state, command, dt);
  return without_slip(vehicle, runge_kutta(vehicle, rear_axle(vehicle, state), command, dt));
}

Motion advanced(const Parameters& vehicle, Motion state, const Command& command, double seconds) {
  // The instants of the world's grid are whole steps, apart from rounding.
  const auto whole = static_cast<int>(seconds / kStep_s + 1e-6);
  for (int step = 0; step < whole; ++step) state = stepped(vehicle, state, command, kStep_s);
  const double rest = seconds - whole * kStep_s;
  return rest > 1e-9 * kStep_s ? stepped(vehicle, state, command, rest) : state;
}

// In a steady turn the axles' slip angles carry the lateral acceleration: d = l w / v + v w (1 / Cf - 1 / Cr) / (mu g).
double steering_for(const Parameters& vehicle, double yaw_rate, const Motion& state) {
  constexpr double kStanding = 1e-3;  // [m/s]
  double angle;
  if (std::abs(state.speed) < vehicle.kinematic_below) {
    angle = std::atan(vehicle.wheelbase() * yaw_rate / std::max(kStanding, state.speed * std::cos(state.slip)));
  } else {
    const double softer = 1.0 / vehicle.front_stiffness - 1.0 / vehicle.rear_stiffness;
    angle = yaw_rate * (vehicle.wheelbase() / state.speed + state.speed * softer / (vehicle.friction * kGravity));
  }
  return std::clamp(angle, -vehicle.largest_steering, vehicle.largest_steering);
}

}  // namespace ttf::sim::world::vehicle
