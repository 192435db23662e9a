// The heading of an object, and the rate at which it turns, from measurements of its axis.
//
// An axis has two ends, and the first measurement chooses one of them for the value. The velocity along the axis tells at
// which end the front is. While it lies within its error, the front may be at either end. Once it has been beyond it, the front
// is remembered, so that an object that slows down or stops keeps it.
//
// The rate is an Ornstein-Uhlenbeck process beside the heading's random walk: with the time constant T and the stationary
// standard deviation s,
//   d heading = rate dt + walk,   d rate = -rate / T dt + noise,   noise of density 2 s^2 / T.
// The configuration's turn_noise q and initial_turn_rate_sigma s0 give T = 2 s0^2 / q. A vehicle turns as it
// moves: s is s0, or the speed times the tightest curvature, if that is less. So a standing object keeps its heading. Steps
// are exact at constant speed (Van Loan: "Computing integrals involving the matrix exponential", 1978).
#pragma once

#include "fusion/config/tracker_config.h"
#include "fusion/linear/gaussian.h"

namespace ttf::fusion::tracks::body {

// A scalar with its variance; `known` after the first measurement.
struct Scalar {
  double value = 0.0;
  double variance = 0.0;
  bool known = false;
};
Scalar predicted(const Scalar& scalar, double noise, double dt);

// Value in [rad], of one end of the axis, and its rate [rad/s] with the covariance of both. An unknown heading has a rate.
struct Heading : Scalar {
  double rate = 0.0, rate_variance = 0.0, covariance = 0.0;
  signed char front = 0;  // 1: at the value's end, -1: at the other one, 0: no velocity has shown it yet
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

// A velocity of so many standard deviations along the axis tells the front. Noise alone has so much in one estimate of two
// million.
inline constexpr double kResolvesFront = 5.0;

// Remembers the front of a known heading, if this velocity tells it.
void update_front(Heading& heading, const linear::Gaussian<2>& velocity);

// Takes over the front that another heading of the same object remembers, if this one remembers none.
void take_front(Heading& heading, const Heading& other);

// Returns the velocity along the value's direction in standard deviations, with its sign.
double ahead_by(const Heading& heading, const linear::Gaussian<2>& velocity);

// Returns the axis or the axis plus half a turn, whichever is nearer to the expected direction: an axis is
// measured up to half a turn.
double nearest_half_turn(double axis, double expected);

}  // namespace ttf::fusion::tracks::body
