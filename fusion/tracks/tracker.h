// The multi-object tracker of all strategies: prediction, gating, association and confirmation. Tracks end
// after lists that missed them, or by silence (given_up() in fusion/tracks/track.h).
//
// Association. nearest is global nearest neighbour (fusion/association/assignment.h), confirmed tracks first.
// With jpda an estimate takes in every observation in its gate, weighted by the probability that it belongs to
// the track (fusion/association/joint_association.h). The most probable joint event then decides hits and
// misses, the newest observation, axis, extent, class and births.
//
// Birth. With m_of_n, M observations in N lists confirm a track, and lists without an observation end it. With
// existence, the probability that the object exists decides both (fusion/tracks/existence.h); delete_misses,
// confirm_hits and confirm_window are not used. Two tracks of one object become one if the configuration says
// so (fusion/tracks/twins.h).
//
// A step is a pure function of the tracks, the list and the configuration. Tracks are values, so a strategy can
// keep snapshots and go back. Random-walk filters estimate heading and extent beside the motion
// (fusion/estimators/estimator.h). The constructor allocates all storage.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/association/assignment.h"
#include "fusion/association/joint_association.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/track.h"
#include "fusion/tracks/twins.h"

namespace ttf::fusion::tracks {

struct TrackSet {
  std::vector<Track> tracks;  // in order of birth
  GlobalTime time{};          // the time of the tracks' states
  bool started = false;

  explicit TrackSet(std::size_t capacity = 0) { tracks.reserve(capacity); }
};

class Tracker {
 public:
  Tracker(const config::TrackerConfig& config, std::size_t max_observations);

  // Takes the list in; list.measured must not be before set.time.
  void step(TrackSet& set, const sensors::ObservationList& list);
  // Does the same, but leaves `before` as it is and writes the tracks after the list into `after`, whose content goes.
  void step(const TrackSet& before, TrackSet& after, const sensors::ObservationList& list);
  // The following parts of a step serve methods for late lists (fusion/strategies/late/). assigned() gates and
  // assigns, and changes no track. It returns the observation of each track, or -1, valid until the next call.
  std::span<const int> assigned(const TrackSet& set, const sensors::ObservationList& list);
  // Corrects heading and extent of an object at its estimate.
  void correct_outline(Track& track, const sensors::Observation& observation) const;
  // Confirms and ends tracks by their counts.
  void prune(TrackSet& set) const;
  // Returns the room for tentative and confirmed tracks together.
  std::size_t max_tracks() const { return max_tracks_; }
  const config::TrackerConfig& config() const { return config_; }
  const estimators::Estimator& estimator() const { return *estimator_; }
  // Returns the number of jpda clusters, over all steps, that were too large for exact probabilities
  // (fusion/association/joint_association.h).
  std::uint64_t approximated_clusters() const { return joint_.approximated(); }

 private:
  void take_in(TrackSet& set, const sensors::ObservationList& list);
  void predict(Track& track, double dt) const;
  struct Placed {
    double x = 0.0, y = 0.0, variance_x = 0.0, variance_y = 0.0;
    std::size_t track = 0;
  };
  void place(const TrackSet& set, SensorId seen_by);
  void associate(const TrackSet& set, const sensors::ObservationList& list);
  template <class Try> void near(const sensors::Observation& position, double gate, const Try& try_one) const;
  void try_pair(const TrackSet& set, const sensors::Observation& observation, std::size_t row, const Placed& placed);
  void offer(const Track& track, const sensors::Observation& observation, int row, int column);
  void judge_existence(Track& track, const sensors::Observation* observation) const;
  void take_in_all(Track& track, std::size_t column, const sensors::ObservationList& list);
  // Corrects everything except the motion.
  void correct_beside(Track& track, const sensors::Observation& observation) const {
    correct_outline(track, observation);
    carry(track.unfiltered, observation);
  }
  void correct_extent(Track& track, const sensors::Observation& observation) const;
  void give_birth(TrackSet& set, const sensors::ObservationList& list);

  config::TrackerConfig config_;
  std::shared_ptr<const estimators::Estimator> estimator_;  // stateless: copies of the tracker share it
  std::size_t max_observations_, max_tracks_;
  double gate_[4] = {};  // by dimension of the observation
  association::Assignment assignment_;
  std::vector<association::Candidate> candidates_;
  // The tracks in strips along x, each sorted by y, so that far ones are skipped. Few tracks are one strip, sorted by x.
  std::vector<Placed> placed_;
  struct Strip {
    double low = 0.0, high = 0.0;  // x
    std::size_t begin = 0, end = 0;
  };
  std::vector<Strip> strips_;  // empty if there is only one
  double largest_variance_x_ = 0.0, largest_variance_y_ = 0.0;
  association::JointAssociation joint_;  // without storage unless jpda
  std::vector<association::Pair> pairs_;
  std::vector<estimators::Explanation> explanations_;
  Twins twins_;
  std::vector<char> near_track_;  // per observation: inside the gate of a confirmed track
  std::vector<int> observation_of_;
};

}  // namespace ttf::fusion::tracks
