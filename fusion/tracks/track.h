// A track, and what an image shows of it.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/extent.h"
#include "fusion/tracks/unfiltered.h"

namespace ttf::fusion::tracks {

// A scalar with its variance; `known` once something was measured.
struct Scalar {
  double value = 0.0;
  double variance = 0.0;
  bool known = false;
};
Scalar predicted(const Scalar& scalar, double noise, double dt);

// One observation among all: the index-th of a measurement. A sensor that restarts counts its measurements anew; what
// was measured at another instant is another one all the same.
struct ObservationId {
  MeasurementId measurement;
  std::uint16_t index = 0;
  GlobalTime measured{};
  bool operator==(const ObservationId&) const = default;
};

struct Track {
  TrackId id = kNoTrack;        // once it has one (fusion/tracks/identities.h)
  ObservationId birth, newest;  // the first observation it took, and the last: how long it has been coasting
  estimators::Estimate estimate;
  Scalar heading;  // [rad], the direction it faces
  Extent extent;
  Unfiltered unfiltered;
  std::uint32_t hits = 0;  // bit i: the scan i scans ago had an observation of it
  int scans = 0;           // since birth, the first included
  int misses = 0;          // scans in a row without an observation
  bool confirmed = false;
  std::uint8_t twin_scans = 0;  // lists in a row that had it for its twin (fusion/tracks/twins.h)
  ObservationId twin;           // the other's birth, where there are any
  double existence = 1.0;       // probability that the object exists (fusion/tracks/existence.h); 1 for births m_of_n
};

// The direction an object faces [rad]: the direction of motion weighed with the measured axis, and with its
// turn; sigma is that of an angle of which nothing is known where neither tells.
struct Facing {
  double heading = 0.0;
  double sigma = 0.0;
};
Facing facing_of(const estimators::Cartesian& estimate, const Scalar& axis);

// An object's axis is measured up to half a turn: the turn that fits the expected direction better is meant.
double nearest_half_turn(double axis, double expected);

struct TrackView {
  TrackId id{};
  GlobalTime valid_at{};
  estimators::State state = estimators::State::Zero();  // (fusion/estimators/estimate.h)
  estimators::Covariance covariance = estimators::Covariance::Zero();
  // Speed: magnitude of the velocity; acceleration: along the heading.
  double heading = 0.0, sigma_heading = 0.0;
  double speed = 0.0, sigma_speed = 0.0;
  double acceleration = 0.0, sigma_acceleration = 0.0;
  // What is typical of vehicles, with its spread, where has_ is clear.
  double length = 0.0, sigma_length = 0.0;
  double width = 0.0, sigma_width = 0.0;
  bool has_length = false, has_width = false;
  bool confirmed = false;
  bool coasting = false;  // not observed of late: predicted only
  Unfiltered unfiltered;
};
// Whether a track whose state is of `time` has ended at `at`, as it is without observations since its newest: by scans
// that did not see it the tracker ends it itself (TrackerConfig::delete_misses); where none come,
//   - when the newest is older than delete_after,
//   - or older than coast_after, and the position predicted to `at` is less certain than delete_position_sigma on an
//     axis.
// Such a track is in no image and takes no observation any more: what it might have been is born anew.
bool given_up(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
              const estimators::Estimator& estimator);

// A track whose state is of `time`, predicted to `at`; never backwards.
TrackView view_of(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator);

}  // namespace ttf::fusion::tracks
