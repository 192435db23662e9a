// Detections of a radar that two bodies share, since its preprocessing joins their returns to one
// (fusion/sensors/resolution.h).
//
// Two confirmed bodies are unresolved if returns of their outlines may be joined (fusion/tracks/resolution/return_bounds.h), by their
// places and range rates, up to three standard deviations. Two detections, one for each, still show them apart. A single one is the
// mean of both outlines, with an unknown share of each. The share depends on their cross-sections and hardly changes from list to list.
// No mean over lists removes its error. So the detection corrects neither track. The list counts neither for nor against them. It
// shows that something is there: no track ends by silence, and none begins.
//
// Blair, Brandt-Pearce: "Unresolved Rayleigh target detection using monopulse measurements" (IEEE Transactions on Aerospace and
// Electronic Systems 34, 1998); Koch, van Keuk: "Multiple hypothesis track maintenance with possibly unresolved measurements" (the
// same, 33, 1997). Both correct the two together, by the centroid with known shares; that needs the correlation of the two tracks.
//
// An outline that surely holds the other's centre is another track of the same object, and shares nothing. Joint association weighs such
// detections by itself. The result depends on nothing but the tracks, the list and the configuration. The constructor allocates all
// storage.
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/parts/association.h"
#include "fusion/tracks/parts/visibility.h"
#include "fusion/tracks/resolution/return_bounds.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::resolution {

class Unresolved {
 public:
  Unresolved(const config::TrackerConfig& config, std::size_t max_tracks);

  // Judges the list, which was associated, and takes shared observations from their tracks. The visibility is that of tracks without
  // an observation.
  void judge(const std::vector<Track>& tracks, const sensors::ObservationList& list,
             const estimators::Estimator& estimator, const parts::Visibility& visibility,
             parts::Association& association);
  // Returns whether a track of the list that was judged last shares its observation.
  bool of(std::size_t track) const { return any_ && shared_[track]; }

 private:
  struct Seen {
    std::size_t track = 0;
    linear::Vector<2> at = linear::Vector<2>::Zero();  // the anchor [m]
    bool bounded = false;                              // the rest holds
    body::SeenBox box;
    double variance = 0.0;  // the position's larger one [m^2]
    ReturnBounds bounds;    // with three standard deviations
  };
  void see(const std::vector<Track>& tracks, const estimators::Estimator& estimator,
           const parts::Visibility& visibility);
  void share(Seen& a, Seen& b, const std::vector<Track>& tracks, const sensors::ObservationList& list,
             const sensors::Resolution& resolution, const estimators::Estimator& estimator,
             parts::Association& association);

  std::vector<sensors::KnownSensor> sensors_;
  std::vector<Seen> seen_;
  double largest_ = 0.0;  // [m], of all diagonals
  double widest_ = 0.0;   // [m^2], of all variances of positions
  bool any_ = false;
  std::vector<char> shared_;  // by track
};

}  // namespace ttf::fusion::tracks::resolution
