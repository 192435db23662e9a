// The resolution of a radar's objects: how near two returns are that its preprocessing joins to one.
//
// Two returns may be joined if their range, their distance across the line of sight and their range rate differ by no more than their
// gates. Errors of the azimuths widen the gate across. Where objects pass the sensor, the gate of the range rate grows with the
// difference of the azimuths. Preprocessing takes narrower gates where three returns show two bodies.
#pragma once

#include <cmath>
#include <limits>

namespace ttf::fusion::sensors {

struct Resolution {
  double range_m = 0.0;
  double across_m = 0.0;
  double azimuth_sigma_rad = 0.0;  // a return has this error
  double rate_mps = 0.0;
  double transverse_speed_mps = 0.0;                               // objects pass the sensor this fast, at most
  double rate_span_mps = std::numeric_limits<double>::infinity();  // range rates are known up to multiples of this

  // Returns how far across returns may be that are joined, of which the nearer has this range [m].
  double across(double range) const {
    constexpr double kThreeOfADifference = 4.25;  // standard deviations of one
    return across_m + kThreeOfADifference * range * azimuth_sigma_rad;
  }
  // Returns whether two returns with these differences [m], [rad], [m/s] may be joined. The nearer one has this range [m].
  bool joins(double range, double further, double turn, double faster) const {
    return std::abs(further) <= range_m && range * std::abs(turn) <= across(range) &&
           std::abs(std::remainder(faster, rate_span_mps)) <= rate_mps + transverse_speed_mps * std::abs(turn);
  }
};

}  // namespace ttf::fusion::sensors
