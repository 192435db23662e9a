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
// A list counts against an object only if its sensor could have seen it (fusion/tracks/visibility.h). M of N leaves out a
// list of a sensor that could not, unless it has an observation. So a track that no sensor can see ends by silence.
//
// A step is a pure function of the tracks, the list and the configuration. Tracks are values, so a strategy can
// keep snapshots and go back. Filters of their own estimate heading and extent beside the motion
// (fusion/estimators/estimator.h), which is that of the point that sensors see (fusion/tracks/anchoring.h). The
// constructor allocates all storage.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "fusion/association/assignment.h"
#include "fusion/association/joint_association.h"
#include "fusion/association/near_places.h"
#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/mounting.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/anchoring.h"
#include "fusion/tracks/distances.h"
#include "fusion/tracks/returns.h"
#include "fusion/tracks/track.h"
#include "fusion/tracks/twins.h"
#include "fusion/tracks/visibility.h"

namespace ttf::fusion::tracks {

struct TrackSet {
  std::vector<Track> tracks;  // in order of birth
  GlobalTime time{};          // the time of the tracks' states
  bool started = false;

  explicit TrackSet(std::size_t capacity = 0) { tracks.reserve(capacity); }
};

// Innovations of a list: of its observations that confirmed tracks took. Squares nu' S^-1 nu are those of the gate. They
// contain all uncertainty of the observed point (fusion/tracks/anchoring.h). With jpda they are those of the most probable
// joint event. Squares and degrees of freedom are sums. They are equal on the average if the filter judges its predictions
// rightly, except that the gate leaves out the largest squares (fusion/metrics/consistency.h).
struct Innovations {
  double squares = 0.0;
  std::uint32_t degrees = 0;
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
  // Returns whether the list that was assigned last counts for or against a track, by its observation or without one.
  bool list_counts(std::size_t track) const {
    return observation_of_[track] >= 0 || visibility_.of(track) > Visibility::kCounts;
  }
  // Corrects the heading by one that was measured `age` seconds ago, and the extent after the update by this observation.
  void correct_heading(Track& track, const sensors::Observation& observation, double age = 0.0) const;
  void correct_extent(Track& track, const sensors::Observation& observation) const;
  // How an observation counts for its track: as one of its anchor (fusion/tracks/anchoring.h), which may have moved.
  struct Referred {
    bool elsewhere = false;  // it is of another point than the anchor
    bool moved = false;
    bool spread = false;                      // `counted` has the spread of its returns
    Anchor from{};                            // the anchor before
    estimators::Displacement displacement{};  // if moved
    sensors::Observation counted{};           // if elsewhere and not moved, or with spread

    const sensors::Observation& of(const sensors::Observation& observed) const {
      return spread || (elsewhere && !moved) ? counted : observed;
    }
  };
  // Refers a late observation, of a track as it was at that instant. The size learns; a silhouette gives way, if it may.
  Referred referred_late(Track& then, const sensors::Observation& observation, bool may_move) const;
  // Returns how the observation `index` of the list that step() took in last counted.
  const Referred& taken(std::size_t index) const { return taken_[index]; }
  // Returns the innovations of the list that step() or assigned() was given last.
  const Innovations& innovations() const { return innovations_; }
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
  void predict(Track& track, const HeadingStep& turn, double dt) const;
  void place(const TrackSet& set, const sensors::ObservationList& list);
  void associate(const TrackSet& set, const sensors::ObservationList& list);
  void sum_innovations(const TrackSet& set, const sensors::ObservationList& list);
  void try_pair(const TrackSet& set, const sensors::Observation& observation, const linear::Vector<2>& sight,
                std::size_t row, const association::Place& placed);
  void judge_pair(const Track& track, const sensors::Observation& observation, std::size_t row, int column,
                  const Distance* distance, const sensors::Mounting& mounting);
  void offer(const Track& track, const sensors::Observation& observation, int row, int column);
  void judge_existence(Track& track, std::size_t column, const sensors::Observation* observation, double visible);
  void take_in_all(Track& track, std::size_t column, const sensors::ObservationList& list);
  sensors::Observation referred(const Track& track, const sensors::Observation& observation) const;
  void count_elsewhere(Track& track, const sensors::Observation& observation, const Distance& distance, bool moves,
                       Referred& taken) const;
  static void count_spread(const std::optional<sensors::Observation>& spread, Referred& taken);
  const sensors::Observation& refer(Track& track, std::size_t column, const sensors::Observation& observation,
                                    std::size_t row);
  const Distance* distance_of(const Track& track, std::size_t column, const sensors::Observation& observation);
  // Takes the spread of a radar's returns into account, if the observation lacks it.
  std::optional<sensors::Observation> spread_on(const Track& track, const sensors::Observation& observation) const {
    if (observation.returns == 0) return std::nullopt;
    return with_spread(observation, track, *estimator_, observation.from);
  }
  // The same of a track of the present list's set, which it has not changed yet.
  std::optional<sensors::Observation> spread_on(const Track& track, std::size_t column,
                                                const sensors::Observation& observation) {
    if (observation.returns == 0) return std::nullopt;
    return with_spread(observation, spreads_.of(column, track, *estimator_, observation.from));
  }
  std::optional<Distance> distance_of(const Track& track, const sensors::Observation& observation) const {
    return distance_to(track, *estimator_, observation, observation.from);
  }
  void give_birth(TrackSet& set, const sensors::ObservationList& list);

  config::TrackerConfig config_;
  std::shared_ptr<const estimators::Estimator> estimator_;  // stateless: copies of the tracker share it
  std::size_t max_observations_, max_tracks_;
  double gate_[4] = {};         // by dimension of the observation
  bool bounds_ranges_ = false;  // beyond_gate() holds for the filter
  association::Assignment assignment_;
  std::vector<association::Candidate> candidates_;
  std::vector<double> squares_;  // nu' S^-1 nu of each candidate
  Innovations innovations_;
  association::NearPlaces places_;  // where the tracks' anchors are
  Distances distances_;
  Spreads spreads_;
  association::JointAssociation joint_;  // without storage unless jpda
  std::vector<association::Pair> pairs_;
  std::vector<estimators::Explanation> explanations_;
  std::vector<sensors::Observation> explained_;
  Twins twins_;
  Visibility visibility_;         // to the present list's sensor
  std::vector<Referred> taken_;   // by observation
  std::vector<char> near_track_;  // per observation: inside the gate of a confirmed track
  std::vector<int> observation_of_;
};

}  // namespace ttf::fusion::tracks
