// The association of a list's observations with tracks, from the pairs in the gate (fusion/tracks/parts/gate.h).
//
// nearest is global nearest neighbour (fusion/association/assignment.h), confirmed tracks first. With jpda an estimate takes in
// every observation in its gate, weighted by the probability that it belongs to the track
// (fusion/association/joint_association.h). The most probable joint event then decides hits and misses, the newest observation,
// axis, extent, class and births. It has the largest product of weights. So it contains no pair that is less probable than both
// alone.
//
// The result does not depend on the order of the pairs. The constructor allocates all storage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/association/assignment.h"
#include "fusion/association/joint_association.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/innovations.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks::parts {

class Association {
 public:
  Association(const config::TrackerConfig& config, std::size_t max_observations, std::size_t max_tracks);

  bool is_joint() const { return config_.association == config::Association::kJpda; }
  // Begins a list: forgets all pairs.
  void begin();
  // Offer the pair of observation `row` and the track, the column-th of its set. Its squared distance lies within the gate.
  void offer(const Track& track, double gate, double distance_squared, std::size_t row, std::size_t column);
  // The same for joint association, from the fit of the observation, as one of the track's anchor, and the track's visibility.
  void offer(const Track& track, const sensors::Observation& observation, const estimators::Fit& fit, double visible,
             std::size_t row, std::size_t column);
  // Associates by the pairs that were offered.
  void solve(const std::vector<Track>& tracks, const sensors::ObservationList& list);

  // Take back a part of solve(): an observation begins no track; the marked tracks have no observation, and theirs begin none.
  void begin_none(std::size_t row) { near_confirmed_[row] = 1; }
  void withdraw(std::span<const char> marked, const std::vector<Track>& tracks, const sensors::ObservationList& list);

  // Results of the last solve().
  // The observation of each track, or -1; more tracks than the set has have none.
  std::span<const int> observation_of() const { return observation_of_; }
  bool is_assigned(std::size_t row) const { return assignment_.column_of()[row] >= 0; }
  // Returns whether the observation lies in the gate of a confirmed track.
  bool near_confirmed(std::size_t row) const { return near_confirmed_[row] != 0; }
  const Innovations& innovations() const { return innovations_; }
  const association::JointAssociation& joint() const { return joint_; }

 private:
  void sum_innovations(const std::vector<Track>& tracks, const sensors::ObservationList& list);

  config::TrackerConfig config_;
  association::Assignment assignment_;
  association::JointAssociation joint_;  // without storage unless jpda
  std::vector<association::Candidate> candidates_;
  std::vector<double> squares_;  // nu' S^-1 nu of each candidate
  std::vector<association::Pair> pairs_;
  std::vector<char> near_confirmed_;  // by observation
  std::vector<int> observation_of_;   // by track
  Innovations innovations_;
};

}  // namespace ttf::fusion::tracks::parts
