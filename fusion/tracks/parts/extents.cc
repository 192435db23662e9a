#include "fusion/tracks/parts/extents.h"

#include <cmath>

#include "fusion/motion/angles.h"
#include "fusion/tracks/body/centre.h"
#include "fusion/tracks/parts/classes.h"

namespace ttf::fusion::tracks::parts {
namespace {

void correct_scalar(body::Scalar& scalar, double innovation, double measured, double sigma) {
  const double variance = sigma * sigma;
  if (!scalar.known) {
    scalar = {measured, variance, true};
    return;
  }
  const double gain = scalar.variance / (scalar.variance + variance);
  scalar.value += gain * innovation;
  scalar.variance = (1.0 - gain) * (1.0 - gain) * scalar.variance + gain * gain * variance;
}

// Returns whether this velocity can tell nothing new of the front. So most tracks need no covariance.
bool remembers_front(const body::Heading& heading, const linear::Vector<2>& velocity) {
  const double ahead = std::cos(heading.value) * velocity.x() + std::sin(heading.value) * velocity.y();
  return !heading.known || heading.front * ahead > 0.0;
}

}  // namespace

void correct_heading(Track& track, const estimators::Estimator& estimator, const sensors::Observation& z, double age) {
  if (!z.has_heading) return;
  const linear::Vector<2> v = estimator.velocity(track.estimate);
  correct(track.heading, z.heading, z.sigma_heading, v.norm() > 1.0 ? std::atan2(v.y(), v.x()) : z.heading, age);
}

void correct_front(Track& track, const estimators::Estimator& estimator) {
  if (!remembers_front(track.heading, estimator.velocity(track.estimate)))
    update_front(track.heading, estimators::velocity_of(estimator.cartesian(track.estimate)));
}

void correct_extent(Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                    const sensors::Observation& z) {
  if (z.has_length) correct_length(track.extent, z.length, z.sigma_length);
  if (z.has_width) correct_width(track.extent, z.width, z.sigma_width);
  if (z.has_length || z.has_width) choose_class(track, config, estimator);
  if (!z.has_span) return;
  const double seen_from = (z.z.head<2>() - z.from.position).norm();
  const double shown = z.span * seen_from;
  correct_scalar(track.shown, shown - track.shown.value, shown, z.sigma_span * seen_from);
  const SeenSpan span{z.from.position, z.span, z.sigma_span};
  choose_class(track, config, estimator, &span);
  if (const auto aspect = aspect_of(track, estimator.cartesian(track.estimate), span.from))
    correct_span(track.extent, *aspect, span.angle, span.sigma);
}

}  // namespace ttf::fusion::tracks::parts
