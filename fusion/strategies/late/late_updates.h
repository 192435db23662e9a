// Takes late lists in by a method for single states (fusion/oosm/): it corrects the newest tracks and never
// rewinds.
//
// In order, the tracker steps as always, and its estimates equal those of rewinding to the last bit. Beside
// every track the method keeps a past of the same positions (fusion/strategies/late/pasts.h). A late list
//   - is associated with the tracks as the method sees them at the list's instant: the state then, given everything
//     taken in since, with its covariance. The method's own innovation refers to that state (law L9 of
//     fusion/oosm/method.h). It is the retrodicted state, or the clone, which every later update has corrected too; for
//     a track without later observations it is the prediction. Gates and assignment are as always: an exact method's
//     innovation is chi-square as in order.
//   - updates each assigned track by the method; the track's estimate is then the method's, predicted to the newest
//     list.
// Later associations stay as they are, and an unassigned observation begins no track. Rewinding
// (fusion/tracks/timeline.h) associates anew. A track takes no part if it was born later or if its past is too
// short. A list without any such track is too old, and so is a list before the last config.history_scans.
//
// Beside the state:
//   counters  The list counts at its place among the others, as a hit or a miss, or not at all
//             (fusion/tracks/parts/visibility.h). So hits, misses and lists are those in order, without lists in which the track
//             took no part. Tracks are confirmed, and end, by these counts.
//   newest    It moves if the late observation is the track's newest.
//   anchor    A late observation counts for the anchor that the track had then (fusion/tracks/body/distance.h). When an anchor
//             moves, the states since are displaced, and those before stay (law L10). A late observation to which a
//             silhouette gives way moves the anchor from its instant on. A track remembers its last kAnchors moves; a
//             list from before those is one in which it takes no part.
//   outline   A late axis is that of the heading less age times turn rate. Sizes are constants, or random walks. Noise
//             since adds to a late value's variance. This is not exact: measurements between share that noise.
//   carried   Scores add up; height and third side are taken unless newer ones are known.
//
// Memory, for max_objects + 3 max_observations objects, each (constant velocity, acceleration):
//   augmented 21, 46 KB; clone 7, 15 KB; adjoint 10, 21 KB; al1, bl1 6, 12 KB; a, b 0.7, 1.4 KB; c 0.4, 0.8 KB.
// Rewinding remembers the tracks after every list instead, 1.3 KB each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fusion/strategies/late/announcements.h"
#include "fusion/strategies/late/pasts.h"
#include "fusion/strategies/strategy.h"
#include "fusion/tracks/identities.h"
#include "fusion/tracks/track_history.h"
#include "fusion/tracks/tracker.h"

namespace ttf::fusion::strategies::late {

class LateUpdates final : public tracks::TrackHistory {
 public:
  // Requires a config.late other than rewind. Clones take late lists of scheduled sensors only, other methods
  // of any.
  LateUpdates(const config::TrackerConfig& config, std::size_t max_observations, std::span<const SensorTiming> sensors);

  Insertion insert(const sensors::ObservationList& list) override;
  tracks::Innovations innovations() const override { return tracker_.innovations(); }
  const tracks::TrackSet& current() const override { return set_; }
  const estimators::Estimator& estimator() const override { return tracker_.estimator(); }
  bool contains(const MeasurementId& id, GlobalTime measured) const override;

 private:
  struct Taken {
    MeasurementId id;
    GlobalTime measured{};
  };
  // The anchor of a track before the list of `id`, at which it moved.
  struct Before {
    tracks::body::Anchor anchor;
    MeasurementId id;
    GlobalTime moved{};
  };
  static constexpr std::size_t kAnchors = 4;
  // The additional state of a track.
  struct Object {
    tracks::ObservationId birth;
    std::size_t slot = 0;                    // its past's
    GlobalTime z_at{}, height_at{};          // when the carried values of the third axis were measured
    std::uint64_t counted = 0;               // bit i: the list i lists ago counted for or against the track
    int lists = 0;                           // the track's, so far
    std::array<Before, kAnchors> anchors{};  // oldest first
    std::size_t moves = 0;                   // ever: the last kAnchors are remembered

    void note(const Before& before);
    // Returns whether the anchor has not moved since a list.
    bool keeps_anchor_since(const MeasurementId& id, GlobalTime measured) const;
    // Returns the anchor at a list, from before it; no value if that is forgotten. `present` is the newest one.
    std::optional<tracks::body::Anchor> anchor_at(const MeasurementId& id, GlobalTime measured,
                                                  const tracks::body::Anchor& present) const;
  };
  void step(const sensors::ObservationList& list);
  bool mend(const sensors::ObservationList& list, int lists_since);
  void mend(tracks::Track& track, Object& object, const tracks::ObservationId& which, const sensors::Observation& z,
            const When& when, tracks::Track& then);
  void align();

  tracks::Tracker tracker_;
  tracks::Identities identities_;
  std::unique_ptr<Pasts> pasts_;
  Announcements announcements_;
  tracks::TrackSet set_;
  std::vector<Object> objects_;      // the set's tracks, in the same order
  std::vector<std::size_t> free_;    // slots
  tracks::TrackSet then_;            // the tracks that take part in the current late list, at its instant
  std::vector<std::size_t> places_;  // then_'s tracks in the set
  std::vector<Taken> lists_;         // chronological
  std::optional<Taken> forgotten_;   // the newest forgotten list
};

}  // namespace ttf::fusion::strategies::late
