// The multi-object tracker all strategies share: prediction, gating, association, confirmation, deletion by scans that
// did not see a track, and by silence (given_up() in fusion/tracks/track.h).
//
// Association. nearest: global nearest neighbour (fusion/association/assignment.h), confirmed tracks first. jpda: the
// estimate takes in every observation in its gate with the probability that it is the track's
// (fusion/association/joint_association.h). Who had what, for hits and misses, what is newest, axis, extent, class and
// births, is then the one most probable joint event. Birth. m_of_n: confirmed by M observations in N scans, ended by
// scans without. existence: both by the probability that the object exists (fusion/tracks/existence.h); delete_misses,
// confirm_hits and confirm_window are not asked. Twins: two tracks of one object become one, if told
// (fusion/tracks/twins.h).
//
// A step is a pure function of the tracks, the scan and the configuration; tracks are values, so that a
// strategy can keep snapshots and go back. Heading and extent are random-walk filters beside the estimate of
// the motion (fusion/estimators/estimator.h). Storage is taken at construction: nothing allocates afterwards.
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
  GlobalTime time{};          // the tracks' states are of this instant
  bool started = false;

  explicit TrackSet(std::size_t capacity = 0) { tracks.reserve(capacity); }
  // Copies within the capacity: no allocation.
  void assign(const TrackSet& other);
};

class Tracker {
 public:
  Tracker(const config::TrackerConfig& config, std::size_t max_observations);

  // Takes the scan in; scan.measured must not be before set.time.
  void step(TrackSet& set, const sensors::Scan& scan);
  // The parts of a step that whoever takes late scans in (fusion/strategies/late/) has use for:
  // which observation of the scan each track takes, or -1: gated and assigned, no track changed; valid until the next
  // call.
  std::span<const int> assigned(const TrackSet& set, const sensors::Scan& scan);
  // Heading and extent, of an object that is where its estimate says.
  void correct_outline(Track& track, const sensors::Observation& observation) const;
  // Confirms and ends tracks by their counts.
  void prune(TrackSet& set) const;
  // Room for tentative and confirmed tracks together.
  std::size_t max_tracks() const { return max_tracks_; }
  const config::TrackerConfig& config() const { return config_; }
  const estimators::Estimator& estimator() const { return *estimator_; }
  // Clusters of a jpda tracker, in all steps, that were too large for exact probabilities
  // (fusion/association/joint_association.h).
  std::uint64_t approximated_clusters() const { return joint_.approximated(); }

 private:
  void predict_all(TrackSet& set, GlobalTime to) const;
  void sort_by_x(const TrackSet& set, SensorId seen_by);
  void associate(const TrackSet& set, const sensors::Scan& scan);
  void offer(const Track& track, const sensors::Observation& observation, int row, int column);
  void judge_existence(Track& track, const sensors::Observation* observation) const;
  void take_in_all(Track& track, std::size_t column, const sensors::Scan& scan);
  // What is estimated, and carried, beside the motion.
  void correct_beside(Track& track, const sensors::Observation& observation) const {
    correct_outline(track, observation);
    carry(track.unfiltered, observation);
  }
  void correct_extent(Track& track, const sensors::Observation& observation) const;
  void give_birth(TrackSet& set, const sensors::Scan& scan);

  config::TrackerConfig config_;
  std::shared_ptr<const estimators::Estimator> estimator_;  // without state: copies of the tracker share it
  std::size_t max_observations_, max_tracks_;
  double gate_[4] = {};  // by dimension of the observation
  association::Assignment assignment_;
  std::vector<association::Candidate> candidates_;
  struct Placed {
    double x = 0.0, y = 0.0, variance_x = 0.0, variance_y = 0.0;
    std::size_t track = 0;
  };
  std::vector<Placed> by_x_;  // the tracks, sorted: who is far away is not looked at
  double largest_variance_x_ = 0.0;
  association::JointAssociation joint_;  // without storage unless jpda
  std::vector<association::Pair> pairs_;
  std::vector<estimators::Explanation> explanations_;
  Twins twins_;
  std::vector<char> near_track_;  // per observation: inside the gate of a confirmed track
  std::vector<int> observation_of_;
};

}  // namespace ttf::fusion::tracks
