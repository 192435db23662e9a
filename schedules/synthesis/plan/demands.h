// Sections of a plan for objectives that lie above schedules.
//
//   plan.error:                        the expected squared error of position at use
//     process_noise: 1                 the density of the noise [m^2/s^3; of a walk m^2/s]
//     process_noises: [0.01, 1, 25]    instead: the largest ratio to the least error of each density counts
//     sigma: {laser: 0.1, camera: 0.3} a measurement's standard deviation [m], for each sensor with a chain
//     motion: constant_velocity        or random_walk
//     over: uses                       the mean over all uses, or time: over all time, with each use held
//   plan.gap_error:                    the expected squared error of the gap of a vehicle that follows another one
//     time_gap: 1.8 s                  of the law (nodes/control/time_gap.h)
//     lag: 200 ms                      of the drive train
//     memory: 10 s                     the speed of the vehicle ahead forgets
//     density: 1                       of the noise that drives that speed [m^2/s^3]
//     delay: 0 ms                      from the end of a chain until the command acts
// All of plan.gap_error may be absent, and motion and over. A copy of a sensor has its original's sigma, if
// it has none and is of the same kind.
#pragma once

#include <optional>
#include <vector>

#include "core/time.h"

namespace ttf {
class YamlMap;
}

namespace ttf::schedules::synthesis::plan {

struct Plan;

struct ErrorDemand {
  bool over_time = false;                       // else over uses
  bool random_walk = false;                     // else constant velocity
  std::vector<double> process_noises;           // one: the error itself; several: regret
  std::vector<std::optional<double>> sigmas_m;  // by sensor; all that begin chains
};

struct GapErrorDemand {
  double time_gap_s = 1.8, lag_s = 0.2, memory_s = 10.0, density = 1.0;
  Duration delay{};
};

// Reads both sections into a plan whose chains and objectives are complete. Adds findings.
void read_demands(YamlMap& section, Plan& plan);

}  // namespace ttf::schedules::synthesis::plan
