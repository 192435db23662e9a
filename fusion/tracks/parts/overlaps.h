// Two objects are never in one place. If the places of two confirmed tracks overlap, the less certain one ends:
//   - the one that was not observed in this list, if the other one was;
//   - else the one with the larger variance of its centre;
//   - else the younger one.
// A tentative track is not confirmed while it overlaps a confirmed one, but remains and takes its observations.
//
// A place is what a track surely covers (fusion/tracks/footprint.h), so that cars parked bumper to bumper keep their
// tracks while their lengths are unknown. Only tracks whose anchors are near each other are compared, in order of x. The constructor
// allocates all storage.
#pragma once

#include <cstddef>
#include <vector>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class Overlaps {
 public:
  explicit Overlaps(std::size_t max_tracks);

  // Returns whether the track, the index-th, overlaps a confirmed one. Tracks are in order of birth, with states of instant `time`.
  bool overlaps_confirmed(const std::vector<Track>& tracks, std::size_t index, GlobalTime time,
                          const config::TrackerConfig& config, const estimators::Estimator& estimator) const;
  // Ends the less certain one of each two confirmed tracks that overlap.
  void end(std::vector<Track>& tracks, GlobalTime time, const config::TrackerConfig& config,
           const estimators::Estimator& estimator);

 private:
  // Where an object may be: about its anchor.
  struct Near {
    double x = 0.0, y = 0.0, reach = 0.0;  // [m]
    std::size_t track = 0;
  };
  static Near near_of(const Track& track, std::size_t index, const estimators::Estimator& estimator);

  std::vector<Near> by_x_;   // confirmed tracks
  std::vector<char> ended_;  // by track
};

}  // namespace ttf::fusion::tracks::parts
