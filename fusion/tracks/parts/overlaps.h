// Two objects are never in one place. If the places of two confirmed tracks overlap, the less certain one ends:
//   - the one that was not observed in this list, if the other one was;
//   - else the one with the larger variance of its centre;
//   - else the younger one.
// A tentative track is not confirmed while it overlaps a confirmed one, but remains and takes its observations.
//
// A place is what a track surely covers (fusion/tracks/footprint.h), so that cars parked bumper to bumper keep their
// tracks while their lengths are unknown. All pairs are compared: O(n^2) for n confirmed tracks. No allocation.
#pragma once

#include <vector>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

// Tracks are in order of birth, with states of instant `time`.
bool overlaps_confirmed(const std::vector<Track>& tracks, const Track& track, GlobalTime time,
                        const config::TrackerConfig& config, const estimators::Estimator& estimator);
void end_overlaps(std::vector<Track>& tracks, GlobalTime time, const config::TrackerConfig& config,
                  const estimators::Estimator& estimator);

}  // namespace ttf::fusion::tracks::parts
