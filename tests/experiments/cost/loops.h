// Control loops with published costs, and a vehicle that follows another one.
#pragma once

#include <initializer_list>
#include <vector>

#include "experiments/cost/control_loop.h"
#include "tests/experiments/cost/expected_cost.h"

namespace ttf::experiments::cost {

// By rows.
inline Eigen::MatrixXd matrix(int rows, int columns, std::initializer_list<double> values) {
  Eigen::MatrixXd result(rows, columns);
  int at = 0;
  for (const double value : values) {
    result(at / columns, at % columns) = value;
    ++at;
  }
  return result;
}

// A servo 1000 / (s (s + 1)) with a PD controller (distributed.m of Jitterbug). The input has white noise of density 1. The cost is
// E(y^2 + u^2). The period is `h`, the grain h / 40.
enum class ServoDelays { kConstant, kUniform, kCompensated };
// `total`: both delays together at most, in grains. `loss`: a share of commands that the actuator does not get.
ExpectedCost servo(double h, int total, ServoDelays delays, double loss = 0.0);

// 6 / ((s + 1) (s + 2)) with the gain -1 (kushner.m). The period is 1.42, a grain of the delay 1.42 / 50.
ExpectedCost kushner(const Delays& delay);

// Ball and beam with a PID controller outside and a P controller inside (multirate.m).
enum class BeamRates { kBothSlow, kBothFast, kMultirate };
ExpectedCost ball_and_beam(BeamRates rates);

// A vehicle with the default gains of nodes/control/time_gap.h. The lead's speed is driven by white noise of density 1
// m^2/s^3, and forgets. Lists come every 40 ms, which are so many grains. A command rests on the list of `periods`
// before. It goes out after a delay in grains.
struct FollowingLoop {
  double time_gap_s = 1.5;
  double lag_s = 0.3;      // the drive train's
  double memory_s = 20.0;  // the lead's speed forgets
  int grains = 4;
};
struct Following {
  double gap_m = 0.0, acceleration = 0.0;  // root mean squares: the gap's error, the acceleration [m/s^2]
};
Following follow(int periods, const Delays& delay, const FollowingLoop& of = {});

}  // namespace ttf::experiments::cost
