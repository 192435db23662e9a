// Adaptive cruise control with a constant time gap.
//
//   a = k1 (d - d0 - h v) + k2 (v_lead - v)
// d is the clearance to the vehicle ahead, d0 that at a standstill, h the time gap. Without a vehicle ahead, or if the set speed
// asks for less, the law is
//   a = k (v_set - v).
// Limits are applied afterwards (limits.h). ISO 15622 asks for h >= 0.8 s, with one setting in 1.5..2.2 s.
//
// Behind a lead of constant speed, without lag and limits, the gap's error e = d - d0 - h v obeys
//   e'' + (h k1 + k2) e' + k1 e = 0.
// The default gains damp it more than critically.
//
// A string of such vehicles is stable if no speed grows from vehicle to vehicle. Without lag the condition is
//   h (h k1 + 2 k2) >= 2.
// The defaults give 2.7. With h = 0.8 s they give 1.3, and the string is unstable. No gains help against a lag above h / 2.
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
