// The ids of confirmed tracks, which stay stable while late lists rewrite the past.
//
// A track's birth is the observation with which it began. Births depend only on the lists in order, so taking
// lists in again gives the same births. A counter of births would not do: a late list with one more object
// would shift all later numbers. The id is a name for the birth. A track gets it when it is first confirmed,
// and so visible.
//   I1  a confirmed track keeps its id as long as it lives
//   I2  the same birth has the same id, even if a late list undid its confirmation, or ended it, for a while
//   I3  if a late list moves a birth, because an earlier observation now begins the track, the id goes to the track
//       with the same newest observation
//   I4  an id is reused only after 65535 others
// Names follow the order of confirmation as it happened. So two strategies may name the same tracks
// differently, but their births agree.
//
// Identities are kept in the order of their births, which is that of a set's tracks. So n tracks take about n
// steps, and n log n where tracks come or go.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/time.h"
#include "fusion/tracks/track_set.h"

namespace ttf::fusion::tracks {

class Identities {
 public:
  explicit Identities(std::size_t max_tracks);
  // Writes the ids into the newest set. No list older than `oldest` can come in any more. Allocates nothing.
  void name(TrackSet& set, GlobalTime oldest);

 private:
  struct Identity {
    ObservationId birth, newest;
    GlobalTime seen{};         // the newest set the track was in
    std::uint64_t number = 0;  // in the order of naming
    TrackId id{};
    bool alive = false;
  };
  // An identity without a track, as it is searched for.
  struct Dead {
    ObservationId newest;
    GlobalTime seen{};
    std::uint64_t number = 0;
    std::size_t index = 0;  // in known_
  };
  static void take(Identity& identity, Track& track, GlobalTime now);
  std::size_t name_by_birth(TrackSet& set);
  void name_by_newest(TrackSet& set);
  void list_dead();
  void name_confirmed(TrackSet& set);
  void make_room(std::size_t count);
  void put_in_order();

  std::size_t most_;
  std::vector<Identity> known_;  // by birth
  std::vector<Dead> dead_;
  std::bitset<1u << 16> taken_;  // ids of living tracks; kNoTrack
  std::uint16_t next_ = 0;
  std::uint64_t named_ = 0;
};

}  // namespace ttf::fusion::tracks
