// The extent of an object is its length and width. Both are estimated jointly, because measurements often mix
// the two.
//
// (length, width) starts at the prior of the configuration (config::Sizes). Both are constants, unless extent_noise lets
// them walk. Sensors measure the
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
#include <optional>

#include "fusion/config/tracker_config.h"

namespace ttf::fusion::tracks::body {

struct Extent {
  Eigen::Vector2d size;  // length, width [m]
  Eigen::Matrix2d covariance;
  Eigen::Vector2d prior_variances;

  explicit Extent(const config::Sizes& prior = {});
  // Return whether the side is measured: known at least twice as well as by the prior.
  bool length_is_measured() const { return covariance(0, 0) <= 0.25 * prior_variances(0); }
  bool width_is_measured() const { return covariance(1, 1) <= 0.25 * prior_variances(1); }
};

// Predicts by dt >= 0 seconds; noise is the spectral density of both random walks [m^2/s].
void predict(Extent& extent, double noise, double dt);

// Keeps both sides positive, as all updates do. A side below 0.1 m is put there, and takes the other one along.
void keep_positive(Extent& extent);

// Updates by a measured value with sigma > 0, [m]. Most of the variance counts as repeating: while range and aspect hardly
// change, the beams' raster meets the outline in the same places.
void correct_length(Extent& extent, double length, double sigma);
void correct_width(Extent& extent, double width, double sigma);

// Updates by one combination of both, h' (length, width), that differs from the expected one by `nu`; `white` and
// `repeating` are the variances of its errors.
void correct_combination(Extent& extent, const Eigen::Vector2d& h, double nu, double white, double repeating);

// The aspect of the outline from the sensor. The range is that of the centre [m]; the angle is the object's
// heading minus the bearing of the line of sight [rad]. Each has its sigma.
struct Aspect {
  double range = 0.0, sigma_range = 0.0;
  double angle = 0.0, sigma_angle = 0.0;
};

// Returns the logarithm of the probability density of a measured span with sigma > 0, [rad], up to a constant. Returns no value
// where the span is not used: if the aspect's sigma exceeds 0.3 rad, or if the outline surrounds the sensor.
std::optional<double> log_density_of_span(const Extent& extent, const Aspect& aspect, double span, double sigma);

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

}  // namespace ttf::fusion::tracks::body
