#include "nodes/control/stanley.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ttf::nodes::control {

double stanley_steering(const StanleyGains& gains, const StanleyInput& input) {
  // A direction is the same after a turn, and the shorter way is the better one.
  const double direction = std::remainder(input.direction_error, 2.0 * std::numbers::pi);
  const double angle = direction + input.steady_slip +
                       std::atan2(gains.offset * input.offset, gains.softening_mps + input.speed) +
                       gains.yaw_rate_s * (input.path_yaw_rate - input.yaw_rate) +
                       gains.steering * (input.steering_before - input.steering_now);
  return std::clamp(angle, -gains.largest_rad, gains.largest_rad);
}

double steady_slip(const AxleLoad& load, double speed, double path_yaw_rate) {
  return load.mass * speed * path_yaw_rate / (load.front_stiffness * (1.0 + load.front_axle / load.rear_axle));
}

}  // namespace ttf::nodes::control
