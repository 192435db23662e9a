// The multi-object tracker of all strategies: the order of the parts in a step. For each list,
//   1. tracks are predicted to it; those that were silent for long end (given_up() in fusion/tracks/track.h);
//   2. its observations are associated with them (fusion/tracks/parts/association.h), of the pairs in the gate
//      (fusion/tracks/parts/gate.h) of the point that each track follows (fusion/tracks/parts/referral.h). A detection of
//      two bodies that a radar does not resolve belongs to none (fusion/tracks/resolution/unresolved.h);
//   3. each track counts the list, if its sensor could have seen the object (fusion/tracks/parts/visibility.h), and is corrected
//      by what belongs to it: its existence (fusion/tracks/parts/existence.h), motion, heading and extent
//      (fusion/tracks/parts/extents.h), and what is carried along (fusion/tracks/unfiltered.h);
//   4. other observations begin tracks (fusion/tracks/parts/birth.h);
//   5. tracks are confirmed and end (fusion/tracks/parts/confirmation.h); of two in one place, the less certain one ends
//      (fusion/tracks/parts/overlaps.h);
//   6. two tracks of one object become one, if the configuration says so (fusion/tracks/parts/twins.h).
//
// M of N leaves out a list of a sensor that could not see the object, unless it has an observation of it. So a track that no
// sensor can see ends by silence.
//
// A step is a pure function of the tracks, the list and the configuration. Tracks are values, so a strategy can
// keep snapshots and go back. The constructor allocates all storage.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "fusion/config/tracker_config.h"
#include "fusion/estimators/estimator.h"
#include "fusion/sensors/observation.h"
#include "fusion/tracks/innovations.h"
#include "fusion/tracks/parts/association.h"
#include "fusion/tracks/parts/confirmation.h"
#include "fusion/tracks/parts/gate.h"
#include "fusion/tracks/parts/joint_update.h"
#include "fusion/tracks/parts/overlaps.h"
#include "fusion/tracks/parts/referral.h"
#include "fusion/tracks/parts/twins.h"
#include "fusion/tracks/parts/visibility.h"
#include "fusion/tracks/resolution/unresolved.h"
#include "fusion/tracks/track_set.h"

namespace ttf::fusion::tracks {

class Tracker {
 public:
  Tracker(const config::TrackerConfig& config, std::size_t max_observations);

  // Takes the list in; list.measured must not be before set.time.
  void step(TrackSet& set, const sensors::ObservationList& list);
  // Does the same, but leaves `before` as it is and writes the tracks after the list into `after`, whose content goes.
  void step(const TrackSet& before, TrackSet& after, const sensors::ObservationList& list);
  // The second part of a step, for methods for late lists (fusion/strategies/late/): associates, and changes no track. Returns
  // the observation of each track, or -1, valid until the next call.
  std::span<const int> assigned(const TrackSet& set, const sensors::ObservationList& list);
  // Returns whether the list that was assigned last counts for or against a track, by its observation or without one.
  bool list_counts(std::size_t track) const {
    return association_.observation_of()[track] >= 0 || (visibility_.counts(track) && !shares(track));
  }
  // Returns whether a track shares an observation of the list that was assigned last, and so has none of its own.
  bool shares(std::size_t track) const { return unresolved_.of(track); }
  // The last part of a step, for the same methods: confirms and ends tracks.
  void confirm_and_end(TrackSet& set) { parts::confirm_and_end(set, config_, *estimator_, overlaps_); }
  // Returns how the observation `index` of the list that step() took in last counted.
  const parts::Referred& taken(std::size_t index) const { return referral_.taken(index); }
  // Returns the innovations of the list that step() or assigned() was given last.
  const Innovations& innovations() const { return association_.innovations(); }
  // Returns the room for tentative and confirmed tracks together.
  std::size_t max_tracks() const { return max_tracks_; }
  const config::TrackerConfig& config() const { return config_; }
  const estimators::Estimator& estimator() const { return *estimator_; }
  // Returns the number of jpda clusters, over all steps, that were too large for exact probabilities
  // (fusion/association/joint_association.h).
  std::uint64_t approximated_clusters() const { return association_.joint().approximated(); }

 private:
  void predict(Track& track, const body::HeadingStep& turn, double dt) const;
  void take_in(TrackSet& set, const sensors::ObservationList& list);
  void take_in(Track& track, std::size_t column, const sensors::ObservationList& list);

  config::TrackerConfig config_;
  std::shared_ptr<const estimators::Estimator> estimator_;  // stateless: copies of the tracker share it
  std::size_t max_observations_, max_tracks_;
  parts::Visibility visibility_;  // to the present list's sensor
  parts::Referral referral_;
  parts::Gate gate_;
  parts::Association association_;
  resolution::Unresolved unresolved_;
  parts::JointUpdate joint_update_;
  parts::Twins twins_;
  parts::Overlaps overlaps_;
};

}  // namespace ttf::fusion::tracks
