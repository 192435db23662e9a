// A track's view in an image: its object's centre, heading and size at an instant.
#pragma once

#include "core/ids.h"
#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimate.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/unfiltered.h"

namespace ttf::fusion::tracks {

struct Track;

struct TrackView {
  TrackId id{};
  GlobalTime valid_at{};
  estimators::State state = estimators::State::Zero();  // the centre's (fusion/estimators/estimate.h)
  estimators::Covariance covariance = estimators::Covariance::Zero();
  // The speed is the magnitude of the velocity; the acceleration is along the heading.
  double heading = 0.0, sigma_heading = 0.0;
  double speed = 0.0, sigma_speed = 0.0;
  double acceleration = 0.0, sigma_acceleration = 0.0;
  // Without its has_ flag, a side is hardly better known than by the prior (config::Sizes).
  double length = 0.0, sigma_length = 0.0;
  double width = 0.0, sigma_width = 0.0;
  bool has_length = false, has_width = false;
  bool confirmed = false;
  bool coasting = false;  // not observed of late: only predicted
  Unfiltered unfiltered;
};

// Returns the view of a track with a state of instant `time`, predicted to `at`, never backwards.
TrackView view_of(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator);

}  // namespace ttf::fusion::tracks
