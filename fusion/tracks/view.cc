#include "fusion/tracks/view.h"

#include <algorithm>
#include <cmath>

#include "fusion/tracks/body/centre.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks {

TrackView view_of(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator) {
  estimators::Estimate later = track.estimate;
  const double dt = std::max(0.0, (at - time).seconds());
  estimator.predict(later, dt);
  const estimators::Cartesian anchor = estimator.cartesian(later);
  const body::Heading axis = predicted(track.heading, config, anchor.x.segment<2>(2).norm(), dt);
  body::Extent extent = track.extent;
  body::predict(extent, config.extent_noise, dt);
  const body::Centre centre =
      centred(track.anchor, extent, axis, predicted(track.shown, body::kTurningSilhouette, dt), anchor);
  const estimators::Cartesian& estimate = centre.estimate;
  TrackView view;
  view.id = track.id;
  view.valid_at = std::max(at, time);
  view.state = estimate.x;
  view.covariance = estimate.p;
  view.confirmed = track.confirmed;
  view.coasting = track.misses >= config.coast_misses || view.valid_at - track.newest.measured > config.coast_after;

  const double vx = estimate.x(2), vy = estimate.x(3);
  view.speed = std::hypot(vx, vy);
  const Eigen::Vector2d along =
      view.speed > 1e-9 ? Eigen::Vector2d(vx / view.speed, vy / view.speed) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Matrix2d velocity = estimate.p.block<2, 2>(2, 2);
  view.sigma_speed = std::sqrt(along.dot(velocity * along));

  view.heading = centre.facing.heading;
  view.sigma_heading = centre.facing.sigma_of_front();
  const Eigen::Vector2d direction(std::cos(view.heading), std::sin(view.heading));
  const Eigen::Matrix2d acceleration = estimate.p.block<2, 2>(4, 4);
  view.acceleration = direction.dot(estimate.x.segment<2>(4));
  view.sigma_acceleration = std::sqrt(std::max(0.0, direction.dot(acceleration * direction)));

  view.length = extent.size(0);
  view.sigma_length = std::sqrt(extent.covariance(0, 0));
  view.has_length = extent.length_is_measured();
  view.width = extent.size(1);
  view.sigma_width = std::sqrt(extent.covariance(1, 1));
  view.has_width = extent.width_is_measured();
  view.unfiltered = track.unfiltered;
  return view;
}

}  // namespace ttf::fusion::tracks
