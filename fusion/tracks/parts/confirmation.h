// The confirmation of tracks, and their end by lists that missed them. (They also end by silence: given_up() in
// fusion/tracks/track.h.)
//
// With m_of_n, M observations in N lists confirm a track; doubtful ones count for nothing. delete_misses lists in a row without
// an observation end it. A tentative track ends when M hits are out of reach within its window. With existence, the probability
// that the object exists decides both (fusion/tracks/parts/existence.h); delete_misses, confirm_hits and confirm_window are not
// used. No more tracks are confirmed than max_objects.
//
// A track whose position has become less certain than delete_position_sigma ends in the next list that misses it. Tracks in one
// place: fusion/tracks/parts/overlaps.h.
#pragma once

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/parts/overlaps.h"
#include "fusion/tracks/track_set.h"

namespace ttf::fusion::tracks::parts {

// Confirms and ends tracks after a list.
void confirm_and_end(TrackSet& set, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                     Overlaps& overlaps);

}  // namespace ttf::fusion::tracks::parts
