// What a strategy takes scans into, in whatever order they come: the tracks, and as much of their past as taking in
// late ones needs. Timeline (fusion/tracks/timeline.h) goes back and takes in again what came after; LateUpdates
// (fusion/strategies/late/late_updates.h) mends the newest tracks by a method for single states.
#pragma once

#include <cstdint>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/tracker.h"

namespace ttf::fusion::tracks {

// The chronological order of scans, ties included.
inline bool before(const MeasurementId& a, GlobalTime a_time, const MeasurementId& b, GlobalTime b_time) {
  if (a_time != b_time) return a_time < b_time;
  return a < b;
}

class TrackHistory {
 public:
  virtual ~TrackHistory() = default;

  enum class Insertion : std::uint8_t { kInOrder, kLate, kTooOld };
  virtual Insertion insert(const sensors::Scan& scan) = 0;
  // The newest tracks, confirmed ones with their ids.
  virtual const TrackSet& current() const = 0;
  virtual const estimators::Estimator& estimator() const = 0;  // of the tracks' estimates
  // Whether this measurement is in it: a sensor that restarts gives its numbers again, to other instants.
  virtual bool contains(const MeasurementId& id, GlobalTime measured) const = 0;
};

}  // namespace ttf::fusion::tracks
