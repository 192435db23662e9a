// The expected squared error of position under measurements that repeat, without any draws.
//
// It is the covariance of the Kalman filter in its periodic state. One axis has K states: the position (a random walk,
// K = 1), or position and velocity (constant velocity, K = 2). White noise of density q drives the last one:
//   P(t + dt) = F P F' + Q(dt),   Q = q dt, or q [dt^3/3, dt^2/2; dt^2/2, dt]
//   P+ = P (I + M P)^-1,          M = H' H / R,   H = [1, 0]
// (Bar-Shalom, Li, Kirubarajan: "Estimation with Applications to Tracking and Navigation", 2001, 5.2.3 and 6.2.2). The
// filter has q and R. Every step has the form P -> h + a P (I + g P)^-1 a'. So has a round of steps, and two rounds.
// Doubling the rounds ends at the periodic covariance, quadratically (Anderson: "Second-order convergent algorithms for
// the steady-state Riccati equation", International Journal of Control 28, 1978).
//
// A use sees the measurements that are known by then. They need not be the first ones in the order of measurement.
#pragma once

#include <vector>

#include "core/time.h"

namespace ttf::experiments::judges {

enum class Motion { kRandomWalk, kConstantVelocity };

// A measurement in each round.
struct Sighting {
  Duration measured{};    // within the round
  double variance = 0.0;  // R [m^2], > 0
  Duration known{};       // from here on uses see it; at or behind `measured`, at any distance
  // Above 0: the instant is any one up to `within` later, for bounds alone (trial_path.h).
  Duration within{};
};

struct Round {
  Duration length{};
  std::vector<Sighting> sightings;  // at least one
  std::vector<Duration> uses;
  // Above 0: a use's error is the mean over so much time from the use on, by prediction alone.
  Duration held{};
};

// Returns by use the expected squared error of one axis [m^2] with the noise density q [m^2/s for a walk, m^2/s^3], >
// 0. The instants are known: `within` is 0.
std::vector<double> errors_at_uses(const Round& round, Motion motion, double density);

// Returns their mean.
double mean_error(const Round& round, Motion motion, double density);

}  // namespace ttf::experiments::judges
