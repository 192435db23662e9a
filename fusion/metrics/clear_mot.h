// CLEAR-MOT matches tracks with objects over time and counts the errors (Bernardin, Stiefelhagen: "Evaluating
// multiple object tracking performance: the CLEAR MOT metrics", EURASIP J. on Image and Video Processing 2008,
// section 2.1). At every instant:
//   C1  An object keeps the track of its last match, however long ago, if both are present and within the gate, even
//       if another track is closer. If several objects had that track, the one matched last keeps it.
//   C2  The other objects and tracks are paired one to one within the gate: first as many as possible, then with the
//       least sum of distances, ties by identity (least_cost_pairs.h, P2: objects and tracks by name).
//   C3  An object without a track is a miss, a track without an object a false positive. An object with another track
//       than at its last match is a switch (a mismatch in the paper), also after misses.
//   C4  The order in which objects and tracks are listed does not matter.
// MOTA = 1 - (misses + false positives + switches) / objects, summed over all instants; MOTP = mean distance of
// the matches [m].
//
// The paper leaves parts of C1 open (the last match, and a track that several objects had) and of C2 (as many
// as possible). Both decisions agree with py-motmetrics, with one exception. There, the first listed of several
// objects keeps the track.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fusion/metrics/identity.h"
#include "fusion/metrics/near_pairs.h"
#include "fusion/metrics/sparse_pairs.h"

namespace ttf::fusion::metrics {

struct ClearMotCounts {
  std::uint64_t instants = 0;
  std::uint64_t objects = 0, tracks = 0;  // summed over the instants
  std::uint64_t matches = 0;              // switched ones too
  std::uint64_t misses = 0, false_positives = 0, switches = 0;
  double distance_sum_m = 0.0;  // over the matches

  // MOTA and MOTP are not a number without objects or matches.
  double mota() const {
    const auto errors = static_cast<double>(misses + false_positives + switches);
    return objects == 0 ? kNothing : 1.0 - errors / static_cast<double>(objects);
  }
  double motp_m() const { return matches == 0 ? kNothing : distance_sum_m / static_cast<double>(matches); }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
};

class ClearMot {
 public:
  // Objects and tracks further apart than `gate_m` (finite, > 0) do not match.
  explicit ClearMot(double gate_m);

  // Returns the matches of one instant in the order of the objects' names, valid until the next call. The storage grows
  // with the largest instant and the number of different objects, and is kept.
  std::span<const Match> step(std::span<const Named> objects, std::span<const Named> tracks);
  // Does the same for any other distance [m]. distances[i * tracks.size() + j] is that of objects[i] and
  // tracks[j], not a number if they do not match.
  std::span<const Match> step(std::span<const Identity> objects, std::span<const Identity> tracks,
                              std::span<const double> distances);

  const ClearMotCounts& counts() const { return counts_; }

 private:
  // The last match of an object.
  struct Last {
    Identity object = 0, track = 0;
    std::uint64_t instant = 0;
  };
  // A possible match: places in the order of names, and the distance.
  struct Near {
    std::size_t object, track;
    double distance_m;
  };
  void begin(std::span<const Identity> objects, std::span<const Identity> tracks);
  std::span<const Match> judge();
  const Last* last_of(Identity object) const;
  void keep();
  void pair_others();
  void remember(Identity object, Identity track);

  double gate_;
  ClearMotCounts counts_;
  std::vector<Last> last_;  // by object
  // One instant. Objects and tracks are in the order of their names; of_object_ and of_track_ are their places in it.
  std::vector<Identity> objects_, tracks_;
  std::vector<std::size_t> of_object_, of_track_;
  std::vector<Near> near_;                 // within the gate, by object, then track
  std::vector<int> track_of_, object_of_;  // SparsePairs::kNone
  std::vector<double> distance_of_;        // by object: how far its track is
  std::vector<Match> matches_;
  std::vector<Identity> names_[2];
  std::vector<Point> points_[2];
  NearPairs near_pairs_;
  SparsePairs pairs_;
};

}  // namespace ttf::fusion::metrics
