// The speed of an object that is driven at random.
//
// Without memory the acceleration is white noise of density q = T sigma^2 [m^2/s^3], for the configuration's standard
// deviation sigma in each step of length T. The speed adds it up, a random walk: in time it goes anywhere, and a car
// stands still at 0.
//
// With a memory tau the speed is the segments' plus a deviation u that the same noise drives and that is forgotten, an
// Ornstein-Uhlenbeck process:
//   du = -u / tau dt + dw,   E dw^2 = q dt,
// It is stationary from the start of the drive on:
//   E u(t)^2 = q tau / 2,   E u(t) u(t + s) = (q tau / 2) exp(-s / tau).
// At the grid's instants the deviation is exact, u(t + T) = f u(t) + sqrt((1 - f^2) q tau / 2) n with f = exp(-T / tau)
// (Gillespie: "Exact numerical simulation of the Ornstein-Uhlenbeck process and its integral", Physical Review E 54,
// 1996); between them the speed goes in a straight line. An object's wish below 0 leaves it standing.
#pragma once

#include "sim/world/size.h"

namespace ttf::sim::world {

struct WorldConfig;

class Speed {
 public:
  // `start` is the segments' speed at the start [m/s], `step` the grid's [s].
  Speed(const WorldConfig& config, double start, const ObjectKey& key, double step);

  double at_start() const;
  // Returns the acceleration [m/s^2] in the next step: `profile` is the segments', `noise` a normal draw, and `speed` what
  // the object drives now.
  double acceleration(double profile, double noise, double speed);
  // Returns the expected part of that [m/s^2], given the deviation before the step: profile - u / tau.
  double steady(double profile) const { return profile - deviation_ * forgetting_; }

 private:
  double sigma_, step_;
  double kept_ = 1.0, spread_ = 0.0;  // the deviation in a step; a spread of 0: no memory
  double forgetting_ = 0.0;           // 1 / tau [1/s]; 0: no memory
  double profile_, deviation_ = 0.0;
};

}  // namespace ttf::sim::world
