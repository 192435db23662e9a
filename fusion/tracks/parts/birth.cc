#include "fusion/tracks/parts/birth.h"

#include "fusion/tracks/body/distance.h"
#include "fusion/tracks/body/returns.h"
#include "fusion/tracks/parts/classes.h"
#include "fusion/tracks/parts/extents.h"

namespace ttf::fusion::tracks::parts {

Track born(const sensors::Observation& z, const ObservationId& id, const config::TrackerConfig& config,
           const estimators::Estimator& estimator) {
  Track track;
  track.birth = track.newest = id;
  track.extent = body::Extent(prior_of(track, config));
  track.estimate = estimator.initial(z.returns > 0 ? with_spread(z, track.extent) : z);
  track.anchor = body::first_anchor(z, z.from);
  track.heading = body::unknown_heading(config);
  if (z.has_heading) correct(track.heading, z.heading, z.sigma_heading, z.heading);
  carry(track.unfiltered, z);
  correct_extent(track, config, estimator, z);
  track.hits = 1;
  track.lists = 1;
  if (config.birth == config::Birth::kExistence) track.existence = config.initial_existence * z.weight;
  return track;
}

void give_birth(TrackSet& set, const sensors::ObservationList& list, const Association& association,
                const config::TrackerConfig& config, const estimators::Estimator& estimator, std::size_t max_tracks) {
  for (std::size_t o = 0; o < list.observations.size(); ++o) {
    if (association.is_assigned(o) || association.near_confirmed(o) || set.tracks.size() == max_tracks) continue;
    const sensors::Observation& z = list.observations[o];
    if (is_outermost(z.seen)) continue;
    if (config.birth == config::Birth::kMOfN && z.weight < sensors::kSureWeight) continue;
    set.tracks.push_back(born(z, {list.id, static_cast<std::uint16_t>(o), list.measured}, config, estimator));
  }
}

}  // namespace ttf::fusion::tracks::parts
