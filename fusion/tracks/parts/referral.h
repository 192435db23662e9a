// Refers the observations of a list to the points that their tracks follow (fusion/tracks/body/distance.h).
//
// An observation of another point than the track's anchor counts as one of the anchor. A radar's has the spread of its returns
// besides (fusion/tracks/body/returns.h). Distances and spreads are computed once for each track and list.
//
// The anchor moves when it is no longer seen (kListsElsewhere). A silhouette gives way at once to an end, a side or a
// corner. The variance of the distance then becomes part of the position's, once.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/body/distances.h"
#include "fusion/tracks/body/reading.h"
#include "fusion/tracks/body/returns.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

// So many lists in a row observed the track elsewhere than at its anchor: then the anchor moves.
inline constexpr int kListsElsewhere = 3;
// A silhouette is no fixed place of its object, so that it takes longer to become an anchor.
inline constexpr int kListsBeforeSilhouette = 12;

// How an observation counts for its track: as one of its anchor, which may have moved.
struct Referred {
  bool elsewhere = false;  // it is of another point than the anchor
  bool moved = false;
  bool spread = false;                      // `counted` has the spread of its returns
  body::Anchor from{};                      // the anchor before
  estimators::Displacement displacement{};  // if moved
  sensors::Observation counted{};           // if elsewhere and not moved, or with spread

  const sensors::Observation& of(const sensors::Observation& observed) const {
    return spread || (elsewhere && !moved) ? counted : observed;
  }
};

// Refers a late observation, of a track as it was at that instant. The size is corrected; a silhouette gives way, if it may.
Referred referred_late(Track& then, const estimators::Estimator& estimator, const sensors::Observation& observation,
                       bool may_move);
// Returns the observation as it counts for the track, which keeps its anchor and its size.
sensors::Observation referred(const Track& track, const estimators::Estimator& estimator,
                              const sensors::Observation& observation);

class Referral {
 public:
  Referral(std::shared_ptr<const estimators::Estimator> estimator, std::size_t max_observations, std::size_t max_tracks,
           bool reads_both = false);

  // Begins a list, for this many tracks.
  void begin(std::size_t tracks);
  // Returns the observation in the reading that fits the track (fusion/tracks/body/reading.h): itself, where tracks do not choose their
  // class. It is valid until the next call.
  const sensors::Observation& read(const Track& track, const sensors::Observation& observation) {
    if (!reads_both_) return observation;
    read_ = body::better_reading(track, *estimator_, observation);
    return read_ ? *read_ : observation;
  }
  // Forgets what was computed for a track whose heading changes.
  void forget(std::size_t column);

  // Returns the distance of an observed point from the anchor of the track, the column-th of its set, and null if they are
  // one point. It is valid until the next call.
  const body::Distance* distance_of(const Track& track, std::size_t column, const sensors::Observation& observation) {
    return distances_.of(column, track, *estimator_, observation, observation.from);
  }
  // Returns the spread of a radar's returns over the track's outline, and null for an observation without returns.
  const linear::Matrix<3>* spread_of(const Track& track, std::size_t column, const sensors::Observation& observation) {
    return observation.returns > 0 ? &spreads_.of(column, track, *estimator_, observation.from) : nullptr;
  }
  // Returns the observation as one of the track's anchor at this distance (or null), with all of its uncertainty: for gates
  // and likelihoods. It is valid until the next call.
  const sensors::Observation& expected(const Track& track, std::size_t column, const sensors::Observation& observation,
                                       const body::Distance* distance);
  // Refers the row-th observation of the list to the anchor of its track, or moves the anchor to the observed point.
  // Returns the observation to update by, which is valid until the next list.
  const sensors::Observation& refer(Track& track, std::size_t column, const sensors::Observation& observation,
                                    std::size_t row);
  // Returns how the row-th observation was referred.
  const Referred& taken(std::size_t row) const { return taken_[row]; }

 private:
  std::shared_ptr<const estimators::Estimator> estimator_;
  body::Distances distances_;
  body::Spreads spreads_;
  std::vector<Referred> taken_;                         // by observation
  std::optional<sensors::Observation> spread_, moved_;  // of expected()
  bool reads_both_;
  std::optional<sensors::Observation> read_;
};

}  // namespace ttf::fusion::tracks::parts
