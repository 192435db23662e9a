#include "nodes/control/proportional_integral.h"

#include <algorithm>

namespace ttf::nodes::control {

double ProportionalIntegral::step(double error, double dt, double& integral) const {
  const double wanted = kp * error + integral;
  const double output = std::clamp(wanted, smallest, largest);
  integral += dt * (ki * error + (output - wanted) / tracking_s);
  return output;
}

}  // namespace ttf::nodes::control
