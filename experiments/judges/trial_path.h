// A bound of the expected error from below, for all instants of measurements in their windows, by one trial path.
//
// Let J be the information of all data about the path x(.) of the position up to a use at time 0. The error of l(x) is
//   E = l' J^-1 l = max over paths u of  l(u)^2 / (D(u) + sum over measurements of u(t)^2 / R),
//   D(u) = (1/q) times the integral of u''^2  (constant velocity),  or of u'^2  (random walk),
// by the inequality of Cauchy and Schwarz. The path of the maximum is u(t) = Cov(x(t), l(x) | data), that of the
// smoother (Rauch, Tung, Striebel: "Maximum likelihood estimates of linear dynamic systems", AIAA Journal 3, 1965;
// the functional is that of Wahba: "Spline models for observational data", 1990, 1.3). Any other path has less. So one
// path bounds the error of all instants at once: u^2 counts where it is largest in each window,
//   E >= l(u)^2 / (D(u) + sum over measurements of max over the window of u^2 / R).
// The path is that of the newest instants. The bound is their error itself where newer measurements are worth more.
//
// Paths are cubic between measurements (straight for a walk), twice as long as they matter, and end in a ramp to 0.
#pragma once

#include "experiments/judges/periodic_error.h"

namespace ttf::experiments::judges {

// Returns a bound of the mean error at uses (mean_error) for any instants within the sightings' windows. A measurement
// is known as long behind its instant as `known` is behind `measured`.
double bounded_mean_error(const Round& round, Motion motion, double density);

}  // namespace ttf::experiments::judges
