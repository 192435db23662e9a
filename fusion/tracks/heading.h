// The heading of an object's front, and the rate at which it turns, from measurements of its axis.
//
// The rate is an Ornstein-Uhlenbeck process beside the heading's random walk: with the time constant T and the stationary
// standard deviation s,
//   d heading = rate dt + walk,   d rate = -rate / T dt + noise,   noise of density 2 s^2 / T.
// The configuration's turn_noise q and initial_turn_rate_sigma s0 give T = 2 s0^2 / q. A vehicle turns as it
// moves: s is s0, or the speed times the tightest curvature, if that is less. So a standing object keeps its heading. Steps
// are exact at constant speed (Van Loan: "Computing integrals involving the matrix exponential", 1978).
#pragma once

#include "fusion/config/tracker_config.h"

namespace ttf::fusion::tracks {

// A scalar with its variance; `known` after the first measurement.
struct Scalar {
  double value = 0.0;
  double variance = 0.0;
  bool known = false;
};
Scalar predicted(const Scalar& scalar, double noise, double dt);

// Value in [rad], of the object's front, and its rate [rad/s] with the covariance of both. An unknown heading has a rate.
struct Heading : Scalar {
  double rate = 0.0, rate_variance = 0.0, covariance = 0.0;
};

// Returns the heading of a new track, before its first measurement.
Heading unknown_heading(const config::TrackerConfig& config);

// Predicts any heading by dt >= 0 seconds, at its object's speed [m/s]. All headings of an instant share the exponentials.
class HeadingStep {
 public:
  HeadingStep(const config::TrackerConfig& config, double dt);
  Heading of(const Heading& heading, double speed) const;

 private:
  double dt_, most_rate_, walk_;      // [s], [rad/s], [rad^2]
  double seconds_;                    // T; 0 if nothing turns
  double left_ = 1.0, reach_ = 0.0;   // the rate's part that is left, and the time that it turns the heading
  double gone_ = 0.0, turned_ = 0.0;  // variances of rate and heading by the rate's noise, for s = 1
};
inline Heading predicted(const Heading& heading, const config::TrackerConfig& config, double speed, double dt) {
  return HeadingStep(config, dt).of(heading, speed);
}

// Updates by an axis that was measured `age` seconds ago, with sigma > 0 [rad]: it is that of value - age rate. The sense of
// the axis is the nearer one to the known heading, or to `likely`.
void correct(Heading& heading, double measured, double sigma, double likely, double age = 0.0);

// Returns the axis or the axis plus half a turn, whichever is nearer to the expected direction: an axis is
// measured up to half a turn.
double nearest_half_turn(double axis, double expected);

}  // namespace ttf::fusion::tracks
