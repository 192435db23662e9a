// A position in the plane with its covariance, composed of independent errors.
#pragma once

#include <cmath>

namespace ttf::fusion::sensors {

// x, y [m] and their covariance [m^2].
struct PlanePosition {
  double x = 0.0, y = 0.0;
  double sxx = 0.0, sxy = 0.0, syy = 0.0;

  // Sets the covariance from two errors [m^2]: along the direction (c, s) of length 1, and across it.
  void set_errors(double c, double s, double along, double across) {
    sxx = c * c * along + s * s * across;
    sxy = c * s * (along - across);
    syy = s * s * along + c * c * across;
  }
  // Adds one error of this variance; one unit of the error moves the position by (dx, dy).
  void add_error(double dx, double dy, double variance) {
    sxx += dx * dx * variance;
    sxy += dx * dy * variance;
    syy += dy * dy * variance;
  }
  // Adds two more errors, as in set_errors().
  void add_errors(double c, double s, double along, double across) {
    sxx = sxx + c * c * along + s * s * across;
    sxy += c * s * (along - across);
    syy = syy + s * s * along + c * c * across;
  }

  double sigma_x() const { return std::sqrt(sxx); }
  double sigma_y() const { return std::sqrt(syy); }
  double correlation() const { return sxy / std::sqrt(sxx * syy); }
};

}  // namespace ttf::fusion::sensors
