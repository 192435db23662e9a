// The gate selects the pairs of an observation and a track that may belong together.
//
// A pair is in the gate if nu' S^-1 nu <= the quantile of chi-square for gate_probability. nu is the innovation of the
// observation as one of the track's anchor, with all uncertainty of the observed point (fusion/tracks/body/distance.h). S is its
// covariance.
//
// Outside the gate on one axis means outside the gate. This cheap bound comes first: with the track's reach, and then with the
// distance of the observed point from its anchor. For a radar's observations it is that of fusion/tracks/parts/polar_gate.h. Most
// pairs end there. Positions are tried with near tracks only (fusion/association/near_places.h).
//
// The constructor allocates all storage; a search allocates nothing.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "fusion/association/near_places.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/parts/association.h"
#include "fusion/tracks/parts/referral.h"
#include "fusion/tracks/parts/visibility.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class Gate {
 public:
  Gate(const config::TrackerConfig& config, std::shared_ptr<const estimators::Estimator> estimator,
       std::size_t max_tracks);

  // Offers the association all pairs in the gate, for tracks that are predicted to the list. The referral has begun the list.
  // Joint association needs the visibility of all tracks.
  void search(const std::vector<Track>& tracks, const sensors::ObservationList& list, const Visibility& visibility,
              Referral& referral, Association& association);

 private:
  // Shared by all pairs of a list.
  struct Search {
    const std::vector<Track>& tracks;
    const Visibility& visibility;
    Referral& referral;
    Association& association;
  };
  void place(const std::vector<Track>& tracks, const sensors::ObservationList& list);
  void try_pair(const Search& search, const sensors::Observation& observation, const linear::Vector<2>& sight,
                std::size_t row, const association::TrackPlace& placed) const;
  void judge_pair(const Search& search, const sensors::Observation& observation, std::size_t row, std::size_t column,
                  const body::Distance* distance) const;

  std::shared_ptr<const estimators::Estimator> estimator_;
  double gate_[4] = {};             // by dimension of the observation
  bool bounds_ranges_;              // beyond_gate() holds for the filter
  association::NearPlaces places_;  // where the tracks' anchors are
};

}  // namespace ttf::fusion::tracks::parts
