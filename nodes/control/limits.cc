#include "nodes/control/limits.h"

#include <algorithm>

namespace ttf::nodes::control {

Limits at_speed(const LimitsBySpeed& limits, double speed) {
  const double span = limits.fast_mps - limits.slow_mps;
  // Equal speeds are a step.
  const double share =
      span > 0.0 ? std::clamp((speed - limits.slow_mps) / span, 0.0, 1.0) : (speed > limits.slow_mps ? 1.0 : 0.0);
  const auto between = [share](double slow, double fast) { return (1.0 - share) * slow + share * fast; };
  return {between(limits.slow.acceleration, limits.fast.acceleration),
          between(limits.slow.deceleration, limits.fast.deceleration), between(limits.slow.jerk, limits.fast.jerk)};
}

double limited(const Limits& limits, double wanted, double before, double dt) {
  const double change = limits.jerk * dt;
  const double within = std::clamp(wanted, -limits.deceleration, limits.acceleration);
  return std::clamp(within, before - change, before + change);
}

}  // namespace ttf::nodes::control
