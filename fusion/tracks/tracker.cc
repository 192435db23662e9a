#include "fusion/tracks/tracker.h"

#include <algorithm>
#include <optional>

#include "core/check.h"
#include "fusion/tracks/parts/birth.h"
#include "fusion/tracks/parts/classes.h"
#include "fusion/tracks/parts/existence.h"
#include "fusion/tracks/parts/extents.h"

namespace ttf::fusion::tracks {

Tracker::Tracker(const config::TrackerConfig& config, std::size_t max_observations)
    : config_(config), estimator_(estimators::make_estimator(config)), max_observations_(max_observations),
      max_tracks_(static_cast<std::size_t>(config.max_objects) + 3 * max_observations),
      visibility_(config, max_tracks_),
      referral_(estimator_, max_observations, max_tracks_, parts::chooses_class(config)),
      gate_(config, estimator_, max_tracks_), association_(config, max_observations, max_tracks_),
      unresolved_(config, max_tracks_), joint_update_(config, max_observations), twins_(config, max_tracks_),
      overlaps_(max_tracks_) {}

void Tracker::step(TrackSet& set, const sensors::ObservationList& list) {
  if (!set.started) {
    set.started = true;
    set.time = list.measured;
  }
  const double dt = (list.measured - set.time).seconds();
  const body::HeadingStep turn(config_, dt);
  for (Track& track : set.tracks) predict(track, turn, dt);
  set.time = list.measured;
  std::erase_if(set.tracks,
                [&](const Track& track) { return given_up(track, set.time, set.time, config_, *estimator_); });
  take_in(set, list);
}

// Each track is predicted where its copy is, while it is near.
void Tracker::step(const TrackSet& before, TrackSet& after, const sensors::ObservationList& list) {
  TTF_CHECK(before.tracks.size() <= after.tracks.capacity(), "{} tracks into {}", before.tracks.size(),
            after.tracks.capacity());
  after.time = list.measured;
  after.started = true;
  after.tracks.clear();
  const double dt = before.started ? (list.measured - before.time).seconds() : 0.0;
  const body::HeadingStep turn(config_, dt);
  for (const Track& track : before.tracks) {
    Track& copy = after.tracks.emplace_back(track);
    predict(copy, turn, dt);
    if (given_up(copy, after.time, after.time, config_, *estimator_)) after.tracks.pop_back();
  }
  take_in(after, list);
}

void Tracker::predict(Track& track, const body::HeadingStep& turn, double dt) const {
  estimator_->predict(track.estimate, dt);
  track.heading = turn.of(track.heading, estimator_->velocity(track.estimate).norm());
  track.shown = predicted(track.shown, body::kTurningSilhouette, dt);
  body::predict(track.extent, config_.extent_noise, dt);
  if (config_.birth == config::Birth::kExistence) track.existence = parts::survived(track.existence, dt, config_);
}

// Where all pairs are weighed, each needs its visibility. Else only tracks without an observation need theirs.
std::span<const int> Tracker::assigned(const TrackSet& set, const sensors::ObservationList& list) {
  TTF_CHECK(list.observations.size() <= max_observations_, "{} observations", list.observations.size());
  const bool weighs_all = association_.is_joint() || config_.birth == config::Birth::kExistence;
  if (weighs_all) visibility_.judge(set.tracks, *estimator_, list.id.sensor, {}, list.vehicle);
  referral_.begin(set.tracks.size());
  association_.begin();
  gate_.search(set.tracks, list, visibility_, referral_, association_);
  association_.solve(set.tracks, list);
  const std::span<const int> observation_of = association_.observation_of();
  if (!weighs_all) visibility_.judge(set.tracks, *estimator_, list.id.sensor, observation_of, list.vehicle);
  unresolved_.judge(set.tracks, list, *estimator_, visibility_, association_);
  return observation_of.first(set.tracks.size());
}

// Takes the list in at its instant.
void Tracker::take_in(TrackSet& set, const sensors::ObservationList& list) {
  assigned(set, list);
  for (std::size_t t = 0; t < set.tracks.size(); ++t) take_in(set.tracks[t], t, list);
  parts::give_birth(set, list, association_, config_, *estimator_, max_tracks_);
  confirm_and_end(set);
  if (config_.merge_probability > 0.0) twins_.unite(set.tracks, list, *estimator_);
}

// The existence is judged by the prediction. The axis comes before the position, which it refers to the anchor.
void Tracker::take_in(Track& track, std::size_t column, const sensors::ObservationList& list) {
  if (shares(column)) {
    track.shared = list.measured;
    return;
  }
  const int observation = association_.observation_of()[column];
  const auto row = static_cast<std::size_t>(observation);
  const sensors::Observation* z = observation >= 0 ? &referral_.read(track, list.observations[row]) : nullptr;
  if (list_counts(column)) count_newest(track, z != nullptr);
  track.doubtful = (track.doubtful << 1) | (z && z->weight < sensors::kSureWeight ? 1u : 0u);
  if (z) track.newest = {list.id, static_cast<std::uint16_t>(row), list.measured};
  if (!association_.is_joint() && config_.birth == config::Birth::kExistence) {
    std::optional<estimators::Fit> fit;
    if (z)
      fit = estimator_->fit(track.estimate,
                            referral_.expected(track, column, *z, referral_.distance_of(track, column, *z)));
    track.existence = parts::after_list(track.existence, z, fit, config_, visibility_.of(column));
  }
  const sensors::Observation* counts = nullptr;
  if (z) {
    parts::correct_heading(track, *estimator_, *z);
    if (z->has_heading) referral_.forget(column);
    counts = &referral_.refer(track, column, *z, row);
  }
  if (association_.is_joint())
    joint_update_.update(track, column, list, association_.joint(), *estimator_, visibility_.of(column));
  else if (counts)
    estimator_->update(track.estimate, *counts);
  if (!z) return;
  parts::correct_front(track, *estimator_);
  carry(track.unfiltered, *z);
  parts::correct_extent(track, config_, *estimator_, *z);
}

}  // namespace ttf::fusion::tracks
