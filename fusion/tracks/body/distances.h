// The distances of a list's observations from the anchors of the tracks (fusion/tracks/body/distance.h).
//
// A distance depends on the track and on the observed point of its object, not on where the observation is. All
// silhouettes of a list are the same point of a track's object, and nearly all ends are. So each distance is computed
// once, however many observations are near the body. The results are those of distance_to().
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fusion/tracks/body/distance.h"

namespace ttf::fusion::tracks::body {

// Returns how far [m] an observed point of the object may be from the track's anchor, which is `at`: by size, with the
// uncertainty of size and heading up to this gate. The mounting is the observing sensor's.
double reach_of(const Body& body, const linear::Vector<2>& at, const sensors::Mounting& mounting, double gate);

class Distances {
 public:
  explicit Distances(std::size_t max_tracks) : has_(max_tracks), of_track_(max_tracks) {}

  // Forgets all distances, for a list and this many tracks.
  void begin(std::size_t tracks);
  // Forgets the distances of a track that changes.
  void forget(std::size_t index) { has_[index] = {}; }
  // Returns the distance of the observation from the anchor of the track, the index-th of its set, and null if they are
  // one point. It is valid until the next call.
  const Distance* of(std::size_t index, const Body& body, const estimators::Estimator& estimator,
                     const sensors::Observation& observation, const sensors::Mounting& mounting) {
    // Most pairs of a list ask for a silhouette's distance again, so that this way is in line.
    const OfTrack& known = of_track_[index];
    if (has_[index].distance && observation.seen == sensors::SeenPoint::kSilhouette && !observation.has_heading &&
        known.distance.to.point == sensors::SeenPoint::kSilhouette && known.distance.to.from == mounting.position)
      return &known.distance;
    return computed(index, body, estimator, observation, mounting);
  }

 private:
  struct Has {
    bool axis = false, distance = false;
  };
  struct OfTrack {
    linear::Vector<2> axis;  // the unit vector along the track's heading
    Distance distance;
  };
  const Distance* computed(std::size_t index, const Body& body, const estimators::Estimator& estimator,
                           const sensors::Observation& observation, const sensors::Mounting& mounting);
  std::vector<Has> has_;  // apart, so that forgetting touches little
  std::vector<OfTrack> of_track_;
  std::optional<Distance> single_;  // where the observation's heading counts
};

}  // namespace ttf::fusion::tracks::body
