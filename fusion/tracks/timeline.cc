#include "fusion/tracks/timeline.h"

#include <algorithm>
#include <utility>

namespace ttf::fusion::tracks {

Timeline::Timeline(const config::TrackerConfig& config, std::size_t max_observations)
    : tracker_(config, max_observations), identities_(tracker_.max_tracks()), base_(tracker_.max_tracks()) {
  const std::size_t entries = config.history_scans + 1;
  entries_.reserve(entries);
  for (std::size_t i = 0; i < entries; ++i) {
    entries_.emplace_back(max_observations, tracker_.max_tracks());
    free_.push_back(entries - 1 - i);
  }
  order_.reserve(entries);
}

const TrackSet& Timeline::current() const { return order_.empty() ? base_ : entries_[order_.back()].after; }

bool Timeline::contains(const MeasurementId& id, GlobalTime measured) const {
  return std::any_of(
             order_.begin(), order_.end(),
             [&](std::size_t e) { return entries_[e].list.id == id && entries_[e].list.measured == measured; }) ||
         (base_is_list_ && base_id_ == id && base_time_ == measured);
}

Timeline::Insertion Timeline::insert(const sensors::ObservationList& list) {
  if (base_is_list_ && before(list.id, list.measured, base_id_, base_time_)) return Insertion::kTooOld;
  // Searches from the end: late lists are rarely very late.
  std::size_t position = order_.size();
  while (position > 0) {
    const StoredList& previous = entries_[order_[position - 1]].list;
    if (!before(list.id, list.measured, previous.id, previous.measured)) break;
    --position;
  }
  const bool late = position < order_.size();
  const std::size_t slot = free_.back();
  free_.pop_back();
  entries_[slot].list.assign(list);
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(position), slot);
  for (std::size_t i = position; i < order_.size(); ++i) {
    process(i);
    if (i == position) innovations_ = tracker_.innovations();
  }
  identities_.name(entries_[order_.back()].after, entries_[order_.front()].list.measured);
  if (free_.empty()) {
    Entry& oldest = entries_[order_.front()];
    std::swap(base_, oldest.after);
    base_id_ = oldest.list.id;
    base_time_ = oldest.list.measured;
    base_is_list_ = true;
    free_.push_back(order_.front());
    order_.erase(order_.begin());
  }
  return late ? Insertion::kLate : Insertion::kInOrder;
}

void Timeline::process(std::size_t position) {
  Entry& entry = entries_[order_[position]];
  tracker_.step(position == 0 ? base_ : entries_[order_[position - 1]].after, entry.after, entry.list.view());
}

}  // namespace ttf::fusion::tracks
