// Two objects are never in one place. If the places of two confirmed tracks overlap, the less certain one ends:
//   - the one that was not observed in this list, if the other one was;
//   - else the one with the larger variance of its centre;
//   - else the younger one.
// A tentative track is not confirmed while it overlaps a confirmed one, but remains and takes its observations. If the confirmed one
// has had none since the tentative one began, the gate refuses its own object: the tentative one takes its place and its identity.
//
// A place is what a track surely covers (fusion/tracks/footprint.h), so that cars parked bumper to bumper keep their tracks while
// their lengths are unknown. Two tracks that a radar has not resolved since both were observed (fusion/tracks/resolution) may drift into
// each other: both stay. Pairs of confirmed tracks are found in order of x, and judged in order of birth. A tentative track is compared
// with all confirmed ones. The constructor allocates the storage of as many pairs as tracks.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class Overlaps {
 public:
  explicit Overlaps(std::size_t max_tracks);

  // Returns the eldest confirmed track that the index-th one overlaps. Tracks are in order of birth, with states of instant `time`.
  std::optional<std::size_t> confirmed_in_place_of(const std::vector<Track>& tracks, std::size_t index, GlobalTime time,
                                                   const config::TrackerConfig& config,
                                                   const estimators::Estimator& estimator) const;
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

  std::vector<Near> by_x_;                                  // confirmed tracks
  std::vector<char> ended_;                                 // by track
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // in one place: the elder, the younger
};

}  // namespace ttf::fusion::tracks::parts
