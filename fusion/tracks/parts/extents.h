// Corrections of a track by its observation, beside the position: heading, front, length and width.
//
// Measurements of the axis and of the sides have filters of their own (fusion/tracks/body/heading.h, fusion/tracks/body/extent.h).
// The velocity tells the front. The span needs the aspect, so the extent comes last, after position, course and axis.
#pragma once

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

// Corrects the heading by an axis that was measured `age` seconds ago.
void correct_heading(Track& track, const estimators::Estimator& estimator, const sensors::Observation& observation,
                     double age = 0.0);
// Remembers the front that the velocity tells after an update.
void correct_front(Track& track, const estimators::Estimator& estimator);
// Corrects the extent and the class after the update by this observation.
void correct_extent(Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                    const sensors::Observation& observation);

}  // namespace ttf::fusion::tracks::parts
