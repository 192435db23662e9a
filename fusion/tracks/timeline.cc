#include "fusion/tracks/timeline.h"

#include <algorithm>
#include <utility>

namespace ttf::fusion::tracks {

Timeline::Timeline(const config::TrackerConfig& config, std::size_t max_observations)
    : tracker_(config, max_observations), identities_(tracker_.max_tracks()), history_(config.history_scans),
      arrived_(max_observations), base_(tracker_.max_tracks()) {
  const std::size_t entries = history_ + kSpacing + 1;
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
             order_.begin() + static_cast<std::ptrdiff_t>(settled_), order_.end(),
             [&](std::size_t e) { return entries_[e].list.id == id && entries_[e].list.measured == measured; }) ||
         (any_settled_ && settled_id_ == id && settled_time_ == measured);
}

Timeline::Insertion Timeline::insert(const sensors::ObservationList& list) {
  arrived_.assign(list);
  return exchange(arrived_);
}

Timeline::Insertion Timeline::exchange(StoredList& list) {
  if (any_settled_ && before(list.id, list.measured, settled_id_, settled_time_)) return Insertion::kTooOld;
  const std::size_t position = place_of(list);
  const bool late = position < order_.size();
  put(list, position);
  if (late)
    rewind(position);
  else
    append();
  identities_.name(entries_[order_.back()].after, entry(settled_).list.measured);
  settle();
  return late ? Insertion::kLate : Insertion::kInOrder;
}

// Searches from the end: late lists are rarely very late.
std::size_t Timeline::place_of(const StoredList& list) const {
  std::size_t position = order_.size();
  while (position > 0) {
    const StoredList& previous = entry(position - 1).list;
    if (!before(list.id, list.measured, previous.id, previous.measured)) break;
    --position;
  }
  return position;
}

void Timeline::put(StoredList& list, std::size_t position) {
  const std::size_t slot = free_.back();
  free_.pop_back();
  std::swap(entries_[slot].list, list);
  entries_[slot].kept = false;
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(position), slot);
}

// Takes in the newest list. Lists that fall behind the reach give their tracks up. The newest one takes their memory, which
// was used of late. Mostly it is that of the list before, whose tracks become the newest where they are.
void Timeline::append() {
  const std::size_t last = order_.size() - 1;
  Entry& newest = entry(last);
  for (; thinned_ + reach_ < last; ++thinned_) {
    Entry& old = entry(thinned_);
    if (!old.kept || !kept_shortly_before(thinned_)) continue;
    old.kept = false;
    std::swap(old.after, newest.after);
  }
  if (last > 0 && !entry(last - 1).kept) {
    tracker_.step(newest.after, newest.list.view());
    newest.kept = true;
  } else {
    take_in(last);
  }
  innovations_ = tracker_.innovations();
}

// Takes in a late list, and all later ones again.
void Timeline::rewind(std::size_t position) {
  reach_ = std::max(reach_, order_.size() - 1 - position);
  std::size_t begin = position;
  while (begin > 0 && !entry(begin - 1).kept) --begin;
  thinned_ = std::min(thinned_, begin);
  for (std::size_t i = begin; i < order_.size(); ++i) {
    take_in(i);
    if (i == position) innovations_ = tracker_.innovations();
  }
}

void Timeline::take_in(std::size_t position) {
  Entry& taken = entry(position);
  tracker_.step(position == 0 ? base_ : entry(position - 1).after, taken.after, taken.list.view());
  taken.kept = true;
}

// Returns whether the base or one of the kSpacing - 1 lists before keeps tracks.
bool Timeline::kept_shortly_before(std::size_t position) const {
  if (position < kSpacing) return true;
  for (std::size_t i = position - (kSpacing - 1); i < position; ++i)
    if (entry(i).kept) return true;
  return false;
}

// The last tracks that only settled lists lead to become the base.
void Timeline::settle() {
  if (order_.size() - settled_ <= history_) return;
  const StoredList& list = entry(settled_).list;
  settled_id_ = list.id;
  settled_time_ = list.measured;
  any_settled_ = true;
  ++settled_;
  std::size_t end = settled_;
  while (end > 0 && !entry(end - 1).kept) --end;
  if (end == 0) return;
  std::swap(base_, entry(end - 1).after);
  free_.insert(free_.end(), order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(end));
  order_.erase(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(end));
  settled_ -= end;
  thinned_ -= std::min(thinned_, end);
}

}  // namespace ttf::fusion::tracks
