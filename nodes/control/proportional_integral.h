// A proportional and integral controller whose integral does not wind up.
//
//   v = kp e + I,   u = v within its limits,   I' = ki e + (u - v) / Tt
// While u is at a limit, the integral goes back to where v would leave it, with the tracking time Tt (Astroem, Haegglund: "PID
// Controllers", 1995, section 3.5). The step is Euler's. So for a constant error at the upper limit,
//   I_n = I* + (I_0 - I*) (1 - dt / Tt)^n,   I* = u - kp e + ki Tt e.
#pragma once

#include <algorithm>

namespace ttf::nodes::control {

struct ProportionalIntegral {
  double kp = 2.5;                        // [output / error]
  double ki = 1.0;                        // [output / error / s]
  double tracking_s = 1.0;                // Tt, at least dt
  double smallest = -6.0, largest = 3.0;  // the output

  // Returns the output for an error, and takes the integral on by `dt` [s]. The integral is the caller's.
  double step(double error, double dt, double& integral) const {
    const double wanted = kp * error + integral;
    const double output = std::clamp(wanted, smallest, largest);
    integral += dt * (ki * error + (output - wanted) / tracking_s);
    return output;
  }
};

}  // namespace ttf::nodes::control
