// The timeline keeps the tracker's past so that it can be rewound: recent lists in chronological order, and the
// tracks after some of them.
//
//      base | list 0 | list 1 | ... | list n-1
//   tracks  ^                 ^              ^  current
//
// A list inserted at the end is one step of the tracker. A list inserted earlier restores the nearest tracks before
// it and takes in all later lists again. So the result is bit-identical to processing in order, for every order of
// arrival. Only the names of the tracks (fusion/tracks/identities.h) remain from before. A list older than the last
// config.history_scans cannot be taken in.
//
// Few lists keep the tracks after them. Where a list was late by n others, the last n + 1 lists keep them, so that the next
// late one finds them. Every kSpacing-th older list keeps them, too. So tracks are not copied while lists come in order,
// and 1,000 of them stay in the processor's cache.
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/tracks/identities.h"
#include "fusion/tracks/track_history.h"
#include "fusion/tracks/tracker.h"

namespace ttf::fusion::tracks {

class Timeline final : public TrackHistory {
 public:
  Timeline(const config::TrackerConfig& config, std::size_t max_observations);

  Insertion insert(const sensors::ObservationList& list) override;
  Insertion exchange(StoredList& list) override;
  Innovations innovations() const override { return innovations_; }
  const TrackSet& current() const override;
  const estimators::Estimator& estimator() const override { return tracker_.estimator(); }
  bool contains(const MeasurementId& id, GlobalTime measured) const override;

 private:
  static constexpr std::size_t kSpacing = 16;

  struct Entry {
    StoredList list;
    TrackSet after;
    bool kept = false;  // `after` holds the tracks after the list
    Entry(std::size_t most_observations, std::size_t most_tracks) : list(most_observations), after(most_tracks) {}
  };
  Entry& entry(std::size_t position) { return entries_[order_[position]]; }
  const Entry& entry(std::size_t position) const { return entries_[order_[position]]; }
  std::size_t place_of(const StoredList& list) const;
  void put(StoredList& list, std::size_t position);
  void append();
  void rewind(std::size_t position);
  void take_in(std::size_t position);
  bool kept_shortly_before(std::size_t position) const;
  void settle();

  Tracker tracker_;
  Identities identities_;
  Innovations innovations_;
  std::size_t history_;
  StoredList arrived_;
  std::vector<Entry> entries_;      // storage, used in any order
  std::vector<std::size_t> order_;  // chronological
  std::vector<std::size_t> free_;
  TrackSet base_;
  std::size_t reach_ = 0;    // by how many lists one was late at most
  std::size_t thinned_ = 0;  // so many lists, the oldest, keep tracks at intervals
  // So many lists, the oldest, are too old to be preceded. They lead from the base to the others.
  std::size_t settled_ = 0;
  MeasurementId settled_id_{};  // the last one that settled
  GlobalTime settled_time_{};
  bool any_settled_ = false;
};

}  // namespace ttf::fusion::tracks
