// Adaptive cruise control with a constant time gap.
//
//   a = k1 (d - d0 - h v) + k2 (v_lead - v)
// d is the clearance to the vehicle ahead, d0 the clearance at a standstill, h the time gap. With an actuator of lag T the string
// of vehicles is stable for h >= 2 T. Without a vehicle ahead, or if the set speed asks for less, the law is
//   a = k (v_set - v).
// Limits are applied afterwards (limits.h). ISO 15622 asks for h >= 0.8 s, with one setting in 1.5..2.2 s.
//
// The gap's error e = d - d0 - h v behind a lead of constant speed obeys e'' + (h k1 + k2) e' + k1 e = 0 without lag and
// limits. The default gains damp it
// more than critically.
#pragma once

#include <optional>

namespace ttf::nodes::control {

struct TimeGapConfig {
  double time_gap_s = 1.5;
  double standstill_m = 2.0;
  double gap_gain = 0.23;    // k1 [1/s^2]
  double speed_gain = 0.74;  // k2 [1/s]
  double set_gain = 0.4;     // k [1/s]
};

struct Ahead {
  double clearance = 0.0;  // [m]
  double speed = 0.0;      // [m/s], over ground
};

// Returns the clearance [m] that the law keeps.
double wanted_clearance(const TimeGapConfig& config, double speed);
// Returns the acceleration [m/s^2] that the law asks for.
double time_gap_acceleration(const TimeGapConfig& config, double speed, double set_speed,
                             const std::optional<Ahead>& ahead);

}  // namespace ttf::nodes::control
