// A track: the belief that one object is there.
#pragma once

#include <cstdint>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/body/body.h"
#include "fusion/tracks/life.h"
#include "fusion/tracks/unfiltered.h"

namespace ttf::fusion::tracks {

struct Track : Life, body::Body {
  std::uint8_t twin_lists = 0;   // lists in a row that suggested a twin (fusion/tracks/parts/twins.h)
  std::uint8_t class_index = 0;  // place among the configured ones (fusion/tracks/parts/classes.h)
  ObservationId twin;            // the twin's birth, if twin_lists > 0
  Unfiltered unfiltered;
};

// Returns whether a track with a state of instant `time` has ended by silence at `at`. Lists that miss it end
// it in the tracker (TrackerConfig::delete_misses). Without lists it ends
//   - when its newest observation, shared ones included, is older than delete_after,
//   - or older than coast_after, and the position predicted to `at` is less certain than delete_position_sigma on an
//     axis.
// Such a track appears in no image and takes no observation; its object begins a new track.
bool given_up(const Track& track, GlobalTime time, GlobalTime at, const config::TrackerConfig& config,
              const estimators::Estimator& estimator);

}  // namespace ttf::fusion::tracks
