// The birth of tracks: an observation that belongs to no track begins one, unless it lies in the gate of a confirmed track.
// There it is a second echo of a known object. The end of a cut outline begins no track: it does not show where the object is.
//
// With m_of_n a doubtful observation begins no track. With existence, a new track has the existence initial_existence, times the
// observation's weight (fusion/tracks/parts/existence.h).
#pragma once

#include <cstddef>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/parts/association.h"
#include "fusion/tracks/track_set.h"

namespace ttf::fusion::tracks::parts {

// Returns the track that begins with this observation. Its object has the prior of the configuration, or of the first class until a size
// is measured.
Track born(const sensors::Observation& observation, const ObservationId& id, const config::TrackerConfig& config,
           const estimators::Estimator& estimator);

// Begins the tracks of a list that was associated; the set has max_tracks at most.
void give_birth(TrackSet& set, const sensors::ObservationList& list, const Association& association,
                const config::TrackerConfig& config, const estimators::Estimator& estimator, std::size_t max_tracks);

}  // namespace ttf::fusion::tracks::parts
