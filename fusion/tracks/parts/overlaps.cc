#include "fusion/tracks/parts/overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fusion/tracks/footprint.h"

namespace ttf::fusion::tracks::parts {
namespace {

struct Covering {
  const Track* track;
  TrackView view;
  Footprint place;
};

Covering covering(const Track& track, GlobalTime time, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator) {
  Covering of{&track, view_of(track, time, time, config, estimator), {}};
  of.place = footprint_of(of.view);
  return of;
}

double variance_of_centre(const Covering& of) { return of.view.covariance(0, 0) + of.view.covariance(1, 1); }

// `elder` was born before `younger`.
bool elder_is_less_certain(const Covering& elder, const Covering& younger) {
  const bool elder_seen = elder.track->hits & 1u, younger_seen = younger.track->hits & 1u;
  if (elder_seen != younger_seen) return younger_seen;
  return variance_of_centre(elder) > variance_of_centre(younger);
}

// Nothing has shown the two apart since a detection that both share: they drift, each by itself (Life::shared).
bool are_unresolved(const Track& a, const Track& b) {
  return a.shared == b.shared && a.shared > std::max(a.newest.measured, b.newest.measured);
}

bool are_in_one_place(const Covering& a, const Covering& b) {
  return overlap_depth(a.place, b.place) > 0.0 && !are_unresolved(*a.track, *b.track);
}

template <class Near> bool may_touch(const Near& a, const Near& b) {
  const double reach = a.reach + b.reach;
  return std::abs(a.x - b.x) <= reach && std::abs(a.y - b.y) <= reach;
}

}  // namespace

Overlaps::Overlaps(std::size_t max_tracks) {
  by_x_.reserve(max_tracks);
  ended_.reserve(max_tracks);
  pairs_.reserve(max_tracks);
}

// An anchor lies on the outline, or half a chord before the centre.
Overlaps::Near Overlaps::near_of(const Track& track, std::size_t index, const estimators::Estimator& estimator) {
  const linear::Vector<2> at = estimator.position(track.estimate).x;
  const double diagonal = track.extent.size.norm();
  return {at.x(), at.y(), track.anchor.point == sensors::SeenPoint::kSilhouette ? 1.5 * diagonal : diagonal, index};
}

std::optional<std::size_t> Overlaps::confirmed_in_place_of(const std::vector<Track>& tracks, std::size_t index,
                                                           GlobalTime time, const config::TrackerConfig& config,
                                                           const estimators::Estimator& estimator) const {
  const Covering own = covering(tracks[index], time, config, estimator);
  const Near here = near_of(tracks[index], index, estimator);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (tracks[t].confirmed && t != index && may_touch(here, near_of(tracks[t], t, estimator)) &&
        are_in_one_place(own, covering(tracks[t], time, config, estimator)))
      return t;
  return std::nullopt;
}

void Overlaps::end(std::vector<Track>& tracks, GlobalTime time, const config::TrackerConfig& config,
                   const estimators::Estimator& estimator) {
  by_x_.clear();
  double largest = 0.0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (!tracks[t].confirmed) continue;
    by_x_.push_back(near_of(tracks[t], t, estimator));
    largest = std::max(largest, by_x_.back().reach);
  }
  if (by_x_.size() < 2) return;
  std::sort(by_x_.begin(), by_x_.end(),
            [](const Near& a, const Near& b) { return a.x != b.x ? a.x < b.x : a.track < b.track; });
  pairs_.clear();
  for (std::size_t i = 0; i < by_x_.size(); ++i) {
    const double until = by_x_[i].x + by_x_[i].reach + largest;
    for (std::size_t j = i + 1; j < by_x_.size() && by_x_[j].x <= until; ++j) {
      const auto [e, y] = std::minmax(by_x_[i].track, by_x_[j].track);
      if (may_touch(by_x_[i], by_x_[j]) &&
          are_in_one_place(covering(tracks[e], time, config, estimator), covering(tracks[y], time, config, estimator)))
        pairs_.emplace_back(e, y);
    }
  }
  if (pairs_.empty()) return;
  std::sort(pairs_.begin(), pairs_.end());
  ended_.assign(tracks.size(), 0);
  for (const auto& [e, y] : pairs_) {
    if (ended_[e] || ended_[y]) continue;
    const Covering elder = covering(tracks[e], time, config, estimator),
                   younger = covering(tracks[y], time, config, estimator);
    ended_[elder_is_less_certain(elder, younger) ? e : y] = 1;
  }
  std::size_t t = 0;
  std::erase_if(tracks, [&](const Track&) { return ended_[t++] != 0; });
}

}  // namespace ttf::fusion::tracks::parts
