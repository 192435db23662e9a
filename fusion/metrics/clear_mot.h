// CLEAR-MOT: which track follows which object over time, and what goes wrong (Bernardin, Stiefelhagen: "Evaluating
// multiple object tracking performance: the CLEAR MOT metrics", EURASIP J. on Image and Video Processing 2008, section
// 2.1). At every instant:
//   C1  keep: an object stays with the track it was last matched to, however long ago, if both are there and within the
//       gate, even where another track is closer. Where several objects were, the one matched last has it.
//   C2  the others, objects and tracks, are paired one to one within the gate: as many as can be, then with the least
//       sum of distances, ties by identity (pairing.h, P2: objects and tracks in the order of their names)
//   C3  an object without a track is a miss, a track without an object a false positive; an object with another track
//       than it was last matched to is a switch (a mismatch in the paper), also after misses
//   C4  the order in which objects and tracks are listed does not matter
// MOTA = 1 - (misses + false positives + switches) / objects, summed over all instants; MOTP = mean distance of the
// matches [m].
//
// What the paper leaves open is in C1 ("last matched" and who has a track that several had) and C2 (as many as can be);
// for both, py-motmetrics decides alike, but for the several: there, the first listed object has the track.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fusion/metrics/identity.h"
#include "fusion/metrics/pairing.h"

namespace ttf::fusion::metrics {

struct ClearMotCounts {
  std::uint64_t instants = 0;
  std::uint64_t objects = 0, tracks = 0;  // summed over the instants
  std::uint64_t matches = 0;              // switched ones too
  std::uint64_t misses = 0, false_positives = 0, switches = 0;
  double distance_sum_m = 0.0;  // of the matches

  // Not a number where there was nothing to judge.
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
  struct Capacity {
    std::size_t objects = 0, tracks = 0;  // at one instant
    std::size_t objects_ever = 0;         // different ones that are ever matched
  };
  // Object and track further apart than `gate_m` (finite, > 0) do not belong together.
  ClearMot(const Capacity& capacity, double gate_m);

  // The matches of one instant, in the order of the objects' names; valid until the next call. Allocates nothing.
  std::span<const Match> step(std::span<const Named> objects, std::span<const Named> tracks);
  // The same by any other distance [m]: that of objects[i] and tracks[j] is distances[i * tracks.size() + j], not a
  // number where they do not belong together.
  std::span<const Match> step(std::span<const Identity> objects, std::span<const Identity> tracks,
                              std::span<const double> distances);

  const ClearMotCounts& counts() const { return counts_; }

 private:
  // The last match of an object.
  struct Last {
    Identity object = 0, track = 0;
    std::uint64_t instant = 0;
  };
  const Last* last_of(Identity object) const;
  void keep(std::span<const Identity> objects, std::span<const Identity> tracks, std::span<const double> distances);
  void pair_others(std::size_t objects, std::size_t tracks, std::span<const double> distances);
  void remember(Identity object, Identity track);

  Capacity capacity_;
  double gate_;
  ClearMotCounts counts_;
  std::vector<Last> last_;  // by object
  std::vector<std::size_t> objects_by_name_, tracks_by_name_;
  std::vector<int> track_of_, object_of_;  // by place in the order of names; Pairing::kNone
  std::vector<Identity> object_names_, track_names_;
  std::vector<double> distances_;
  std::vector<Match> matches_;
  Pairing pairing_;
};

}  // namespace ttf::fusion::metrics
