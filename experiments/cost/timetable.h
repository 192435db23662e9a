// The expected quadratic cost of a control loop whose stages are executed at known instants.
//
// No delay is random. A round has jumps at instants (control_loop.h). Between them the state flows (flow.h). So a round maps
// the second moment by M -> A M A' + R. The sum of A^k R A'^k is stationary. Doubling the number of rounds finds it (Smith:
// "Matrix equation XA + BX = C", SIAM Journal on Applied Mathematics 16, 1968).
#pragma once

#include <vector>

#include "experiments/cost/control_loop.h"
#include "experiments/cost/flow.h"

namespace ttf::experiments::cost {

struct TimedJump {
  double at = 0.0;  // [0, round), in the unit of time of the flow
  Jump jump;
};

// Returns the cost per unit of time of the stationary round; infinite if the loop is not stable. `jumps` are in the
// order of their instants. Those of one instant are executed one after the other.
double timetable_cost(const Flow& flow, double round, const std::vector<TimedJump>& jumps);

}  // namespace ttf::experiments::cost
