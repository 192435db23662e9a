#include "fusion/tracks/track.h"

#include <algorithm>

namespace ttf::fusion::tracks {

bool given_up(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
              const estimators::Estimator& estimator) {
  at = std::max(at, time);
  const Duration silent = at - std::max(track.newest.measured, track.shared);
  if (silent <= config.coast_after) return false;
  if (silent > config.delete_after) return true;
  estimators::Estimate estimate = track.estimate;
  estimator.predict(estimate, (at - time).seconds());
  const double largest = config.delete_position_sigma * config.delete_position_sigma;
  return estimator.position(estimate).p.diagonal().maxCoeff() > largest;
}

}  // namespace ttf::fusion::tracks
