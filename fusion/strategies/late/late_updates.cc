#include "fusion/strategies/late/late_updates.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::fusion::strategies::late {
namespace {

bool is_taken(oosm::Taken taken) { return taken == oosm::Taken::kInOrder || taken == oosm::Taken::kLate; }

// Counts a list at its place, `since` lists before the newest.
void count(tracks::Track& track, int since, bool hit) {
  if (since < 32) {
    const std::uint32_t later = (1u << since) - 1u;
    track.hits = (track.hits & later) | ((track.hits & ~later) << 1) | ((hit ? 1u : 0u) << since);
  }
  ++track.lists;
  if (since <= track.misses) track.misses = hit ? since : track.misses + 1;
}

double widened(double sigma, double variance) { return std::sqrt(sigma * sigma + variance); }

}  // namespace

LateUpdates::LateUpdates(const config::TrackerConfig& config, std::size_t max_observations,
                         std::span<const SensorTiming> sensors)
    : tracker_(config, max_observations), identities_(tracker_.max_tracks()),
      pasts_(make_pasts(config, tracker_.max_tracks())),
      announcements_(config.late == oosm::Kind::kClone ? sensors : std::span<const SensorTiming>()),
      set_(tracker_.max_tracks()), then_(tracker_.max_tracks()) {
  objects_.reserve(tracker_.max_tracks());
  for (std::size_t slot = tracker_.max_tracks(); slot > 0; --slot) free_.push_back(slot - 1);
  places_.reserve(tracker_.max_tracks());
  lists_.reserve(config.history_scans + 1);
}

bool LateUpdates::contains(const MeasurementId& id, GlobalTime measured) const {
  const auto same = [&](const Taken& taken) { return taken.id == id && taken.measured == measured; };
  return std::any_of(lists_.begin(), lists_.end(), same) || (forgotten_ && same(*forgotten_));
}

tracks::TrackHistory::Insertion LateUpdates::insert(const sensors::ObservationList& list) {
  const auto is_before = [&](const Taken& taken) {
    return tracks::before(list.id, list.measured, taken.id, taken.measured);
  };
  if (forgotten_ && is_before(*forgotten_)) return Insertion::kTooOld;
  auto place = lists_.end();
  while (place != lists_.begin() && is_before(*std::prev(place))) --place;
  const bool late = place != lists_.end();
  if (!late)
    step(list);
  else if (!mend(list, static_cast<int>(lists_.end() - place)))
    return Insertion::kTooOld;
  lists_.insert(place, {list.id, list.measured});
  identities_.name(set_, lists_.front().measured);
  if (lists_.size() > tracker_.config().history_scans) {
    forgotten_ = lists_.front();
    lists_.erase(lists_.begin());
  }
  return late ? Insertion::kLate : Insertion::kInOrder;
}

void LateUpdates::step(const sensors::ObservationList& list) {
  const When when = announcements_.when(list);
  for (const oosm::Stamp& due : announcements_.pass(list))
    for (const Object& object : objects_) pasts_->announce(object.slot, due);
  tracker_.step(set_, list);
  align();
  for (std::size_t t = 0; t < set_.tracks.size(); ++t) {
    const tracks::Track& track = set_.tracks[t];
    Object& object = objects_[t];
    if (track.newest.measurement != list.id || track.newest.measured != list.measured) continue;
    const sensors::Observation& z = list.observations[track.newest.index];
    if (z.third.has_z) object.z_at = list.measured;
    if (z.third.has_height) object.height_at = list.measured;
    // The stamp does not fit the method: it starts anew from the tracker's estimate.
    if (track.birth != track.newest && !is_taken(pasts_->take(object.slot, when, z)))
      pasts_->start(object.slot, set_.time, track.estimate);
  }
}

bool LateUpdates::mend(const sensors::ObservationList& list, int lists_since) {
  const When when = announcements_.when(list);
  then_.time = list.measured;
  then_.started = true;
  then_.tracks.clear();
  places_.clear();
  for (std::size_t t = 0; t < set_.tracks.size(); ++t) {
    const tracks::ObservationId& birth = set_.tracks[t].birth;
    if (!tracks::before(birth.measurement, birth.measured, list.id, list.measured)) continue;
    const std::optional<estimators::Estimate> then = pasts_->at(objects_[t].slot, when);
    if (!then) continue;
    then_.tracks.push_back(set_.tracks[t]);
    then_.tracks.back().estimate = *then;
    places_.push_back(t);
  }
  if (places_.empty()) return false;
  const std::span<const int> assigned = tracker_.assigned(then_, list);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    tracks::Track& track = set_.tracks[places_[i]];
    count(track, lists_since, assigned[i] >= 0);
    if (assigned[i] < 0) continue;
    const tracks::ObservationId which{list.id, static_cast<std::uint16_t>(assigned[i]), list.measured};
    mend(track, objects_[places_[i]], which, list.observations[which.index], when, then_.tracks[i]);
  }
  tracker_.prune(set_);
  align();
  return true;
}

void LateUpdates::mend(tracks::Track& track, Object& object, const tracks::ObservationId& which,
                       const sensors::Observation& z, const When& when, tracks::Track& then) {
  const oosm::Taken taken = pasts_->take(object.slot, when, z);
  TTF_CHECK(is_taken(taken), "a late list is not taken although the method has a state at its instant: {}",
            static_cast<int>(taken));
  track.estimate = pasts_->newest(object.slot, set_.time);

  sensors::Observation now = z;
  const double age = (set_.time - which.measured).seconds();
  const double range = (z.z.head<2>() - place_of(tracker_.config().sensors, z.sensor)).norm();
  const double walked = tracker_.config().extent_noise * age;
  now.sigma_heading = widened(z.sigma_heading, tracker_.config().heading_noise * age);
  now.sigma_length = widened(z.sigma_length, walked);
  now.sigma_width = widened(z.sigma_width, walked);
  if (range > 0.0) now.sigma_span = widened(z.sigma_span, walked / (range * range));
  tracker_.correct_outline(then, now);
  track.heading = then.heading;
  track.extent = then.extent;

  const auto newest = [&](bool& has, GlobalTime& at, bool known) {
    has = has && (!known || which.measured >= at);
    if (has) at = which.measured;
  };
  newest(now.third.has_z, object.z_at, track.unfiltered.third.has_z);
  newest(now.third.has_height, object.height_at, track.unfiltered.third.has_height);
  carry(track.unfiltered, now);
  if (tracks::before(track.newest.measurement, track.newest.measured, which.measurement, which.measured))
    track.newest = which;
}

// Drops ended tracks and adds new ones. Tracks are in order of birth, so new ones are at the end.
void LateUpdates::align() {
  std::size_t kept = 0;
  for (const Object& object : objects_) {
    if (kept < set_.tracks.size() && object.birth == set_.tracks[kept].birth)
      objects_[kept++] = object;
    else
      free_.push_back(object.slot);
  }
  objects_.resize(kept);
  for (; kept < set_.tracks.size(); ++kept) {
    const tracks::Track& track = set_.tracks[kept];
    objects_.push_back({.birth = track.birth, .slot = free_.back()});
    free_.pop_back();
    pasts_->start(objects_.back().slot, set_.time, track.estimate);
  }
}

}  // namespace ttf::fusion::strategies::late
