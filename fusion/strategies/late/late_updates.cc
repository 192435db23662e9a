#include "fusion/strategies/late/late_updates.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/check.h"
#include "fusion/tracks/parts/extents.h"

namespace ttf::fusion::strategies::late {
namespace {

bool is_taken(oosm::Taken taken) { return taken == oosm::Taken::kInOrder || taken == oosm::Taken::kLate; }

// Notes a list at its place, `since` lists before the newest. Returns how many of the lists since then counted.
int note(std::uint64_t& counted, int since, bool counts) {
  if (since >= 64) return std::popcount(counted) + (since - 64);
  const std::uint64_t later = (std::uint64_t{1} << since) - 1u;
  const int counted_since = std::popcount(counted & later);
  counted = (counted & later) | ((counted & ~later) << 1) | (std::uint64_t{counts} << since);
  return counted_since;
}

double widened(double sigma, double variance) { return std::sqrt(sigma * sigma + variance); }

// The heading that a track had, as far as its turn rate gives it.
tracks::body::Heading heading_before(const tracks::body::Heading& heading, double age) {
  tracks::body::Heading then = heading;
  then.value -= age * heading.rate;
  then.variance += age * age * heading.rate_variance - 2.0 * age * heading.covariance;
  then.covariance -= age * heading.rate_variance;
  return then;
}

// The variance that noise adds to a heading within `age`, as of a rate that has just been measured.
double heading_noise_since(const config::TrackerConfig& config, double speed, double age) {
  tracks::body::Heading exact;
  exact.known = true;
  return tracks::body::predicted(exact, config, speed, age).variance;
}

}  // namespace

void LateUpdates::Object::note(const Before& before) {
  if (moves >= kAnchors) std::rotate(anchors.begin(), anchors.begin() + 1, anchors.end());
  anchors[std::min(moves, kAnchors - 1)] = before;
  ++moves;
}

bool LateUpdates::Object::keeps_anchor_since(const MeasurementId& id, GlobalTime measured) const {
  if (moves == 0) return true;
  const Before& newest = anchors[std::min(moves, kAnchors) - 1];
  return !tracks::before(id, measured, newest.id, newest.moved);
}

std::optional<tracks::body::Anchor> LateUpdates::Object::anchor_at(const MeasurementId& id, GlobalTime measured,
                                                                   const tracks::body::Anchor& present) const {
  const std::size_t known = std::min(moves, kAnchors);
  for (std::size_t i = 0; i < known; ++i)
    if (tracks::before(id, measured, anchors[i].id, anchors[i].moved)) {
      if (i == 0 && moves > kAnchors) return std::nullopt;
      return anchors[i].anchor;
    }
  return present;
}

LateUpdates::LateUpdates(const config::TrackerConfig& config, std::size_t max_observations,
                         std::span<const SensorTiming> sensors)
    : tracker_(config, max_observations), identities_(tracker_.max_tracks()),
      pasts_(make_pasts(config, tracker_.max_tracks(),
                        std::any_of(sensors.begin(), sensors.end(),
                                    [](const SensorTiming& sensor) { return sensor.measures_ranges; }))),
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
    object.counted = (object.counted << 1) | (track.lists != object.lists ? 1u : 0u);
    object.lists = track.lists;
    if (track.newest.measurement != list.id || track.newest.measured != list.measured) continue;
    const sensors::Observation& z = list.observations[track.newest.index];
    if (z.third.has_z) object.z_at = list.measured;
    if (z.third.has_height) object.height_at = list.measured;
    if (track.birth == track.newest) continue;
    const tracks::parts::Referred& taken = tracker_.taken(track.newest.index);
    if (taken.moved) object.note({taken.from, list.id, list.measured});
    // It starts anew from the tracker's estimate if the stamp does not fit the method.
    if (!is_taken(pasts_->take(object.slot, when, taken.of(z), taken.moved ? &taken.displacement : nullptr)))
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
    const std::optional<estimators::Estimate> estimate = pasts_->at(objects_[t].slot, when);
    const auto anchor = objects_[t].anchor_at(list.id, list.measured, set_.tracks[t].anchor);
    if (!estimate || !anchor) continue;
    tracks::Track& then = then_.tracks.emplace_back(set_.tracks[t]);
    then.estimate = *estimate;
    then.anchor = *anchor;
    then.heading = heading_before(then.heading, (set_.time - list.measured).seconds());
    places_.push_back(t);
  }
  if (places_.empty()) return false;
  const std::span<const int> assigned = tracker_.assigned(then_, list);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    tracks::Track& track = set_.tracks[places_[i]];
    Object& object = objects_[places_[i]];
    const int counted_since = note(object.counted, lists_since, tracker_.list_counts(i));
    if (tracker_.list_counts(i)) tracks::count_late(track, counted_since, assigned[i] >= 0);
    object.lists = track.lists;
    if (tracker_.shares(i)) track.shared = std::max(track.shared, list.measured);
    if (assigned[i] < 0) continue;
    const tracks::ObservationId which{list.id, static_cast<std::uint16_t>(assigned[i]), list.measured};
    mend(track, object, which, list.observations[which.index], when, then_.tracks[i]);
  }
  tracker_.confirm_and_end(set_);
  align();
  return true;
}

void LateUpdates::mend(tracks::Track& track, Object& object, const tracks::ObservationId& which,
                       const sensors::Observation& z, const When& when, tracks::Track& then) {
  sensors::Observation now = z;
  const double age = (set_.time - which.measured).seconds();
  const estimators::Estimator& estimator = tracker_.estimator();
  const double speed = estimator.cartesian(then.estimate).x.segment<2>(2).norm();
  now.sigma_heading = widened(z.sigma_heading, heading_noise_since(tracker_.config(), speed, age));
  tracks::parts::correct_heading(track, estimator, now, age);
  then.heading = heading_before(track.heading, age);
  const bool at_present = object.keeps_anchor_since(which.measurement, which.measured);
  const tracks::parts::Referred referred = tracks::parts::referred_late(then, estimator, z, at_present);
  const oosm::Taken taken =
      pasts_->take(object.slot, when, referred.of(z), referred.moved ? &referred.displacement : nullptr);
  TTF_CHECK(is_taken(taken), "a late list is not taken although the method has a state at its instant: {}",
            static_cast<int>(taken));
  track.estimate = pasts_->newest(object.slot, set_.time);

  const double range =
      z.kind == sensors::ObservationKind::kPosition ? (z.z.head<2>() - z.from.position).norm() : z.z(0);
  const double walked = tracker_.config().extent_noise * age;
  now.sigma_length = widened(z.sigma_length, walked);
  now.sigma_width = widened(z.sigma_width, walked);
  if (range > 0.0) now.sigma_span = widened(z.sigma_span, walked / (range * range));
  tracks::parts::correct_extent(then, tracker_.config(), estimator, now);
  track.extent = then.extent;
  track.shown = then.shown;
  if (referred.moved) {
    object.note({referred.from, which.measurement, which.measured});
    track.anchor = then.anchor;
  }
  if (referred.moved || (at_present && !referred.elsewhere)) track.lists_elsewhere = 0;

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
