// How long and how wide an object is: both jointly, since what is measured is often a mixture of the two.
//
// (length, width) is a random walk that starts as road vehicles in general are. Three things are measured of
// it: the length, the width, and the span, the angle the outline subtends at the sensor. A rectangle L by B
// at range r, turned by the aspect a against the line of sight, spans about (L |sin a| + B |cos a|) / r: the
// width of what drives ahead, the length of what crosses, a mixture in between. The span is taken in as what
// it is, through the exact outline at the known aspect.
//
// Errors that repeat. What aspect and range are off by is the same in the next scan, and the next: a Kalman
// filter that took such errors as independent would soon believe itself certain. So the update is bounded: of
// what it measures, the extent is never known better for it than those errors alone would let it be. With p
// the variance before, v that of the white errors and c that of the repeating ones, the measurement counts
// with the variance max(v + c, p c / (p - c)), which leaves p c / p = c at best, and not at all where p <= c.
// (The bound of a consider state, Schmidt 1966, without carrying its covariance.)
#pragma once

#include <Eigen/Core>

namespace ttf::fusion::tracks {

struct Extent {
  // Road vehicles: 4.5 m by 1.8 m, from motor cycles to light lorries.
  static constexpr double kTypicalLength = 4.5, kTypicalLengthSigma = 2.0;
  static constexpr double kTypicalWidth = 1.8, kTypicalWidthSigma = 0.5;

  Eigen::Vector2d size{kTypicalLength, kTypicalWidth};  // length, width [m]
  Eigen::Matrix2d covariance =
      Eigen::Vector2d(kTypicalLengthSigma * kTypicalLengthSigma, kTypicalWidthSigma* kTypicalWidthSigma).asDiagonal();

  // Measured: known at least twice as well as what is typical.
  bool knows_length() const;
  bool knows_width() const;
};

// By dt >= 0 seconds; noise: spectral density of both random walks [m^2/s].
void predict(Extent& extent, double noise, double dt);

// Measured value and sigma > 0, [m]. Half of the variance counts as repeating: the raster of the beams on the
// outline, and how a fit errs under one aspect.
void correct_length(Extent& extent, double length, double sigma);
void correct_width(Extent& extent, double width, double sigma);

// From where the outline is seen: range of the centre [m] and its sigma; the object's heading less the line
// of sight's bearing [rad] and its sigma.
struct Aspect {
  double range = 0.0, sigma_range = 0.0;
  double angle = 0.0, sigma_angle = 0.0;
};

// Measured span and sigma > 0, [rad]; white. A side seen more flatly than four sigmas of the aspect is not
// told of: its size would be the ratio of two things of which neither is known. Not used at all: where the
// aspect is known worse than to 0.3 rad, where the outline surrounds the sensor, and where the span does not
// belong to such an object (three sigma).
void correct_span(Extent& extent, const Aspect& aspect, double span, double sigma);

// The angle [rad] that a rectangle subtends, and its derivatives by length and width. Nothing to see: zero.
struct Subtended {
  double angle = 0.0;
  Eigen::Vector2d by_size = Eigen::Vector2d::Zero();
};
Subtended subtended(double range, double aspect, const Eigen::Vector2d& size);

}  // namespace ttf::fusion::tracks
