// A track history takes lists in for a strategy, in any order. It keeps the tracks and as much of their past as
// late lists need. Timeline (fusion/tracks/timeline.h) rewinds and takes later lists in again. LateUpdates
// (fusion/strategies/late/late_updates.h) corrects the newest tracks by a method for single states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/innovations.h"
#include "fusion/tracks/track_set.h"

namespace ttf::fusion::tracks {

// Returns whether list a precedes list b in chronological order, ties included.
inline bool before(const MeasurementId& a, GlobalTime a_time, const MeasurementId& b, GlobalTime b_time) {
  if (a_time != b_time) return a_time < b_time;
  return a < b;
}

// A list with its own copy of the observations.
struct StoredList {
  MeasurementId id;
  GlobalTime measured{};
  std::vector<sensors::Observation> observations;
  std::optional<sensors::Mounting> vehicle;

  explicit StoredList(std::size_t most_observations) { observations.reserve(most_observations); }
  void assign(const sensors::ObservationList& list) {
    id = list.id;
    measured = list.measured;
    observations.assign(list.observations.begin(), list.observations.end());
    vehicle = list.vehicle;
  }
  sensors::ObservationList view() const { return {id, measured, observations, vehicle}; }
};

class TrackHistory {
 public:
  virtual ~TrackHistory() = default;

  enum class Insertion : std::uint8_t { kInOrder, kLate, kTooOld };
  virtual Insertion insert(const sensors::ObservationList& list) = 0;
  // The same. Where the history keeps lists, it takes this one's memory and leaves that of another.
  virtual Insertion exchange(StoredList& list) { return insert(list.view()); }
  // Returns the innovations of the list that was taken in last, at its own place.
  virtual Innovations innovations() const = 0;
  // Returns the newest tracks; confirmed ones have their ids.
  virtual const TrackSet& current() const = 0;
  virtual const estimators::Estimator& estimator() const = 0;  // for the tracks' estimates
  // Returns whether this measurement is in the history. The instant counts too: a restarted sensor reuses its
  // numbers.
  virtual bool contains(const MeasurementId& id, GlobalTime measured) const = 0;
};

}  // namespace ttf::fusion::tracks
