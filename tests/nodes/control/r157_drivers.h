// Models of drivers in UN Regulation 157 (automated lane keeping). The regulation takes an accident that such a driver avoids for
// avoidable. The figures are those of the regulation, and of esmini's controllers for it (ControllerALKS_R157SM, 3.6.0).
#pragma once

#include <cmath>

namespace ttf::nodes::control {

inline constexpr double kGravity = 9.81;  // [m/s^2]

// A driver who brakes: nothing happens for `delay_s`, then the deceleration grows by a constant jerk to its largest.
struct Braking {
  double delay_s = 0.0;
  double deceleration = 0.0;  // [m/s^2], the largest
  double rise_s = 0.0;        // until then
};
// The competent and careful human driver evaluates a risk in 0.4 s, reacts in 0.75 s, and then brakes with 0.774 g within 0.6 s.
// This is a jerk of 12.65 m/s^3. The release of the pedal decelerates by 0.4 m/s^2 before. `Braking` leaves that out.
struct CompetentDriver {
  double risk_evaluation_s = 0.4;
  double reaction_s = 0.75;
  double release_deceleration = 0.4;  // [m/s^2]
  double deceleration = 0.774 * kGravity;
  double rise_s = 0.6;
  double critical_time_to_collision_s = 2.0;
  double wandering_m = 0.375;                       // across the lane, which is no cut-in
  double lateral_perception_m = 0.72;               // a cut-in before the driver perceives it
  double emergency_deceleration = 0.85 * kGravity;  // the automatic emergency brake
  double emergency_rise_s = 0.6;                    // at most

  Braking braking() const { return {risk_evaluation_s + reaction_s, deceleration, rise_s}; }
};
// The regulation's own model of a system: 6 m/s^2 at once after 0.35 s.
inline constexpr Braking kRegulationBraking{0.35, 6.0, 0.0};

// Returns the deceleration [m/s^2] at an instant after the event, as long as the vehicle drives.
inline double deceleration_at(const Braking& braking, double seconds) {
  const double since = seconds - braking.delay_s;
  if (since < 0.0) return 0.0;
  return since < braking.rise_s ? braking.deceleration * since / braking.rise_s : braking.deceleration;
}
// Returns the way [m] from the event to the standstill, at a speed [m/s] before.
inline double stopping_distance(const Braking& braking, double speed) {
  const double delayed = speed * braking.delay_s;
  const double lost = 0.5 * braking.deceleration * braking.rise_s;  // speed, while the deceleration grows
  if (lost > 0.0 && lost >= speed) {
    // It stands before that, after t: speed = jerk t^2 / 2.
    const double jerk = braking.deceleration / braking.rise_s;
    const double stands = std::sqrt(2.0 * speed / jerk);
    return delayed + (2.0 / 3.0) * speed * stands;
  }
  const double rising = speed * braking.rise_s - braking.deceleration * braking.rise_s * braking.rise_s / 6.0;
  const double left = speed - lost;
  return delayed + rising + left * left / (2.0 * braking.deceleration);
}

// Returns whether the regulation asks a system to avoid the collision with a vehicle that cuts in. The time to collision [s] is
// that at the entry into the lane. The vehicle is slower by `closing_speed` [m/s]:
//   time to collision > closing speed / (2 * 6 m/s^2) + 0.35 s.
inline bool cut_in_must_be_survived(double time_to_collision, double closing_speed) {
  return time_to_collision > closing_speed / (2.0 * kRegulationBraking.deceleration) + kRegulationBraking.delay_s;
}

}  // namespace ttf::nodes::control
