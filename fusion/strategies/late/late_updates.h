// Late lists by a method for single states (fusion/oosm/): the newest tracks are mended, nothing is gone back to.
//
// In order, the tracker steps as it always does, and its estimates are those of rewinding to the last bit; beside every
// track its past follows under the method (fusion/strategies/late/pasts.h), told of the same positions. A late list
//   - is associated with the tracks as the method sees them at its instant: the state of then given all that was taken
//     since, and its covariance, which is what the method's own innovation is of (law L9 of fusion/oosm/method.h): the
//     retrodicted state, or the clone, which every later update has mended, too; of a track that has seen nothing
//     since, the prediction. Gated and assigned as ever: an exact method's innovation is chi-square as one in order.
//   - updates each assigned track by the method; its estimate is then the method's, predicted to the newest list.
// What was associated later stays so, and an observation that no track takes gives birth to nothing: late data re-opens
// association where the tracker rewinds (fusion/tracks/timeline.h), here it does not. A track that was born later, or
// whose past does not reach back so far, has no part in it; a list that no track has a part in is too old, as is one
// before the last config.history_scans.
//
// Beside the state:
//   counters  the list counts at its place among the others, as a hit or a miss: hits, misses and scans are those of
//             order (of lists that this track had no part in, nothing is counted). Tracks are confirmed, and end, by
//             what they are then.
//   newest    moves where the late observation is the newest this track has.
//   outline   heading and extent are random walks: a late one is taken as one of now, with the variance the walk has
//             added since. Not exact: what was measured between knows of that walk, too.
//   carried   scores add up; height and third side are taken over unless newer ones are known.
//
// Memory, for max_objects + 3 max_observations objects, each (constant velocity, acceleration):
//   augmented 21, 46 KB; clone 7, 15 KB; adjoint 10, 21 KB; al1, bl1 3, 6 KB; a, b 0.5, 1 KB; c 0.3, 0.4 KB.
// Rewinding remembers the tracks after every list instead, 1.1 KB each.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fusion/strategies/late/announcements.h"
#include "fusion/strategies/late/pasts.h"
#include "fusion/strategies/strategy.h"
#include "fusion/tracks/identities.h"
#include "fusion/tracks/track_history.h"

namespace ttf::fusion::strategies::late {

class LateUpdates final : public tracks::TrackHistory {
 public:
  // config.late is not rewind. Clones take late lists of those of the sensors that are scheduled, other methods of any.
  LateUpdates(const config::TrackerConfig& config, std::size_t max_observations, std::span<const SensorTiming> sensors);

  Insertion insert(const sensors::Scan& scan) override;
  const tracks::TrackSet& current() const override { return set_; }
  const estimators::Estimator& estimator() const override { return tracker_.estimator(); }
  bool contains(const MeasurementId& id, GlobalTime measured) const override;

 private:
  struct Taken {
    MeasurementId id;
    GlobalTime measured{};
  };
  // Of a track, beside it.
  struct Object {
    tracks::ObservationId birth;
    std::size_t slot = 0;            // of its past
    GlobalTime z_at{}, height_at{};  // when what it carries of the third axis was measured
  };
  void step(const sensors::Scan& scan);
  bool mend(const sensors::Scan& scan, int lists_since);
  void mend(tracks::Track& track, Object& object, const tracks::ObservationId& which, const sensors::Observation& z,
            const When& when, tracks::Track& then);
  void align();

  tracks::Tracker tracker_;
  tracks::Identities identities_;
  std::unique_ptr<Pasts> pasts_;
  Announcements announcements_;
  tracks::TrackSet set_;
  std::vector<Object> objects_;      // of the set's tracks, one by one
  std::vector<std::size_t> free_;    // slots
  tracks::TrackSet then_;            // the tracks that have a part in the late list at work, as they were
  std::vector<std::size_t> places_;  // of those in the set
  std::vector<Taken> lists_;         // chronological
  std::optional<Taken> forgotten_;   // the newest list that is not remembered
};

}  // namespace ttf::fusion::strategies::late
