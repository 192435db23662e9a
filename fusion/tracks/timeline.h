// The timeline keeps the tracker's past so that it can be rewound: recent lists in chronological order, and the
// tracks after each.
//
//      base | list 0 | list 1 | ... | list n-1
//   tracks  ^        ^        ^               ^  current
//
// A list inserted at the end is one step of the tracker. A list inserted earlier restores the tracks before it
// and takes in all later lists again. So the result is bit-identical to processing in order, for every order of
// arrival. Only the names of the tracks (fusion/tracks/identities.h) remain from before. A full history drops
// its oldest list into the base; a list older than the base cannot be taken in.
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/tracks/identities.h"
#include "fusion/tracks/track_history.h"

namespace ttf::fusion::tracks {

// A list with its own copy of the observations.
struct StoredList {
  MeasurementId id;
  GlobalTime measured{};
  std::vector<sensors::Observation> observations;

  explicit StoredList(std::size_t most_observations) { observations.reserve(most_observations); }
  void assign(const sensors::ObservationList& list) {
    id = list.id;
    measured = list.measured;
    observations.assign(list.observations.begin(), list.observations.end());
  }
  sensors::ObservationList view() const { return {id, measured, observations}; }
};

class Timeline final : public TrackHistory {
 public:
  Timeline(const config::TrackerConfig& config, std::size_t max_observations);

  Insertion insert(const sensors::ObservationList& list) override;
  Innovations innovations() const override { return innovations_; }
  const TrackSet& current() const override;
  const estimators::Estimator& estimator() const override { return tracker_.estimator(); }
  bool contains(const MeasurementId& id, GlobalTime measured) const override;

 private:
  struct Entry {
    StoredList list;
    TrackSet after;
    Entry(std::size_t most_observations, std::size_t most_tracks) : list(most_observations), after(most_tracks) {}
  };
  void process(std::size_t position);

  Tracker tracker_;
  Identities identities_;
  Innovations innovations_;
  std::vector<Entry> entries_;      // storage, used in any order
  std::vector<std::size_t> order_;  // chronological
  std::vector<std::size_t> free_;
  TrackSet base_;
  MeasurementId base_id_{};
  GlobalTime base_time_{};
  bool base_is_list_ = false;  // the base holds a dropped list
};

}  // namespace ttf::fusion::tracks
