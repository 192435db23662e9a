// A track, and its view in an image.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/anchor.h"
#include "fusion/tracks/extent.h"
#include "fusion/tracks/heading.h"
#include "fusion/tracks/unfiltered.h"

namespace ttf::fusion::tracks {

// The identity of an observation: the index-th of a measurement. A restarted sensor counts its measurements
// anew, so the instant distinguishes them.
struct ObservationId {
  MeasurementId measurement;
  std::uint16_t index = 0;
  GlobalTime measured{};
  bool operator==(const ObservationId&) const = default;
};

// Members are in the order of their use: those of every pass over all tracks come first. 1,000 tracks fill a processor's cache.
struct Track {
  TrackId id = kNoTrack;  // set on confirmation (fusion/tracks/identities.h)
  bool confirmed = false;
  std::uint8_t lists_elsewhere = 0;  // lists in a row that observed other points of the object
  std::uint32_t hits = 0;            // bit i: the list i lists ago had an observation of the track
  std::uint32_t doubtful = 0;        // such bits of the doubtful ones among them: these confirm nothing
  int lists = 0;                     // since birth, the first included
  int misses = 0;                    // lists in a row without an observation
  ObservationId birth, newest;       // the first observation and the last
  double existence = 1.0;  // probability that the object exists (fusion/tracks/existence.h); 1 for births m_of_n
  Heading heading;         // the front's direction
  Scalar shown;            // [m], width of the silhouette as cameras see it: tells an unknown heading's depth
  Extent extent;
  Anchor anchor;                  // in the axes of `heading`
  estimators::Estimate estimate;  // the anchor's
  std::uint8_t twin_lists = 0;    // lists in a row that suggested a twin (fusion/tracks/twins.h)
  ObservationId twin;             // the twin's birth, if twin_lists > 0
  Unfiltered unfiltered;
};

// The direction of the object's front [rad]: the course combined with the measured axis, turned by half a turn
// if needed. A slow course against the remembered front is noise, and the axis counts alone. Without both, sigma is that of an
// unknown angle.
struct Facing {
  double heading = 0.0;
  double sigma = 0.0;
  linear::Vector<2> by_velocity = linear::Vector<2>::Zero();  // derivative of the heading by the velocity [rad s/m]
  double axis_variance = 0.0;  // the part of the variance that is not the velocity's [rad^2]
  double reversed = 0.0;       // probability that the front is at the axis' other end, which sigma does not contain
  double sigma_of_front() const;
};
Facing facing_of(const linear::Gaussian<2>& velocity, const Heading& axis);
inline Facing facing_of(const estimators::Cartesian& estimate, const Heading& axis) {
  return facing_of(estimators::velocity_of(estimate), axis);
}

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
// Returns whether a track with a state of instant `time` has ended by silence at `at`. Lists that miss it end
// it in the tracker (TrackerConfig::delete_misses). Without lists it ends
//   - when its newest observation is older than delete_after,
//   - or older than coast_after, and the position predicted to `at` is less certain than delete_position_sigma on an
//     axis.
// Such a track appears in no image and takes no observation; its object begins a new track.
bool given_up(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
              const estimators::Estimator& estimator);

// Returns the view of a track with a state of instant `time`, predicted to `at`, never backwards.
TrackView view_of(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator);

}  // namespace ttf::fusion::tracks
