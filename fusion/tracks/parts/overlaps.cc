#include "fusion/tracks/parts/overlaps.h"

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

}  // namespace

bool overlaps_confirmed(const std::vector<Track>& tracks, const Track& track, GlobalTime time,
                        const config::TrackerConfig& config, const estimators::Estimator& estimator) {
  const Covering own = covering(track, time, config, estimator);
  for (const Track& other : tracks)
    if (other.confirmed && &other != &track &&
        overlap_depth(own.place, covering(other, time, config, estimator).place) > 0.0)
      return true;
  return false;
}

void end_overlaps(std::vector<Track>& tracks, GlobalTime time, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator) {
  const auto erase = [&](std::size_t t) { tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(t)); };
  for (std::size_t e = 0; e < tracks.size();) {
    bool ended = false;
    for (std::size_t y = e + 1; y < tracks.size() && tracks[e].confirmed && !ended;) {
      if (!tracks[y].confirmed) {
        ++y;
        continue;
      }
      const Covering elder = covering(tracks[e], time, config, estimator),
                     younger = covering(tracks[y], time, config, estimator);
      if (!(overlap_depth(elder.place, younger.place) > 0.0)) {
        ++y;
      } else if (elder_is_less_certain(elder, younger)) {
        erase(e);
        ended = true;
      } else {
        erase(y);
      }
    }
    if (!ended) ++e;
  }
}

}  // namespace ttf::fusion::tracks::parts
