// The extent of an object is its length and width. Both are estimated jointly, because measurements often mix
// the two.
//
// (length, width) is a random walk that starts at the typical size of road vehicles. Sensors measure the
// length, the width, and the span, the angle of the outline as seen from the sensor. A rectangle L by B at
// range r, turned by the aspect a against the line of sight, spans about (L |sin a| + B |cos a|) / r. The span
// gives the width of an object ahead, the length of a crossing object, and a mixture in between. The update
// uses the exact outline at the known aspect.
//
// Errors of aspect and range repeat from list to list. A Kalman filter that treated them as independent would
// soon be overconfident. So the update is bounded: the variance never falls below that of the repeating errors
// alone. With p the variance before, v that of the white errors and c that of the repeating ones, the
// measurement counts with the variance max(v + c, p c / (p - c)). This leaves p c / p = c at best; if p <= c,
// the measurement is unused. (This is the bound of a consider state, Schmidt 1966, without carrying its
// covariance.)
#pragma once

#include <Eigen/Core>

namespace ttf::fusion::tracks {

struct Extent {
  // Road vehicles from motor cycles to light lorries: 4.5 m by 1.8 m.
  static constexpr double kTypicalLength = 4.5, kTypicalLengthSigma = 2.0;
  static constexpr double kTypicalWidth = 1.8, kTypicalWidthSigma = 0.5;

  Eigen::Vector2d size{kTypicalLength, kTypicalWidth};  // length, width [m]
  Eigen::Matrix2d covariance =
      Eigen::Vector2d(kTypicalLengthSigma * kTypicalLengthSigma, kTypicalWidthSigma* kTypicalWidthSigma).asDiagonal();

  // Returns whether the side is measured: known at least twice as well as the typical size.
  bool knows_length() const;
  bool knows_width() const;
};

// Predicts by dt >= 0 seconds; noise is the spectral density of both random walks [m^2/s].
void predict(Extent& extent, double noise, double dt);

// Updates by a measured value with sigma > 0, [m]. Half of the variance counts as repeating, from the raster of
// the beams on the outline and from the fit's error under one aspect.
void correct_length(Extent& extent, double length, double sigma);
void correct_width(Extent& extent, double width, double sigma);

// The aspect of the outline from the sensor. The range is that of the centre [m]; the angle is the object's
// heading minus the bearing of the line of sight [rad]. Each has its sigma.
struct Aspect {
  double range = 0.0, sigma_range = 0.0;
  double angle = 0.0, sigma_angle = 0.0;
};

// Updates by a measured span with sigma > 0, [rad], white. A side that is foreshortened to less than four
// sigmas of the aspect is not updated: its size would be the ratio of two unknowns. The span is not used if the
// aspect's sigma exceeds 0.3 rad, if the outline surrounds the sensor, or if the span does not fit the object
// (three sigma).
void correct_span(Extent& extent, const Aspect& aspect, double span, double sigma);

// The angle [rad] that a rectangle subtends, and its derivatives by length and width; zero if the outline
// surrounds the sensor.
struct Subtended {
  double angle = 0.0;
  Eigen::Vector2d by_size = Eigen::Vector2d::Zero();
};
Subtended subtended(double range, double aspect, const Eigen::Vector2d& size);

}  // namespace ttf::fusion::tracks
