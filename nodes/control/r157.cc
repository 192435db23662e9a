#include "nodes/control/r157.h"

#include <algorithm>
#include <cmath>

namespace ttf::nodes::control {
namespace {

constexpr double kSlow_mps = 10.0 / 3.6, kHundred_kmh_mps = 100.0 / 3.6;
constexpr double kShortest_m = 2.0;

}  // namespace

double minimum_following_distance(double speed) {
  const double gap = speed < kSlow_mps ? 1.0 + (std::max(2.0, speed) - 2.0) / 7.8 : 1.0 + speed / kHundred_kmh_mps;
  return std::max(kShortest_m, gap * speed);
}

double deceleration_at(const Braking& braking, double seconds) {
  const double since = seconds - braking.delay_s;
  if (since < 0.0) return 0.0;
  return since < braking.rise_s ? braking.deceleration * since / braking.rise_s : braking.deceleration;
}

double stopping_distance(const Braking& braking, double speed) {
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

bool cut_in_must_be_survived(double time_to_collision, double closing_speed) {
  return time_to_collision > closing_speed / (2.0 * kRegulationBraking.deceleration) + kRegulationBraking.delay_s;
}

}  // namespace ttf::nodes::control
