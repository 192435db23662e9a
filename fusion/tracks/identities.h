// Who is who: the ids of confirmed tracks, stable however late scans rewrite the past.
//
// A track's birth is the observation it began with. That is a pure function of the scans in order, so that
// taking in scans again gives the same births; a number counted up at each birth would not be: a late scan
// with one more object would shift all that follow. The id is a name for it, given when a track is first
// confirmed, which is when anybody hears of it.
//   I1  a track that is confirmed keeps its id as long as it lives
//   I2  the same birth has the same id, also where a late scan undid its confirmation, or ended it, for a while
//   I3  where a late scan moves a birth (the object was seen before, which begins the track now), the id goes
//       to the track that took the same newest observation
//   I4  an id is not given again before 65535 others were
// Names are in order of confirmation as it happened, so two strategies may name the same tracks differently;
// births do not differ.
#pragma once

#include <cstdint>
#include <vector>

#include "core/time.h"
#include "fusion/tracks/tracker.h"

namespace ttf::fusion::tracks {

class Identities {
 public:
  explicit Identities(std::size_t max_tracks);
  // Writes the ids into the newest set. Scans from before `oldest` cannot be taken in any more. Allocates
  // nothing.
  void name(TrackSet& set, GlobalTime oldest);

 private:
  struct Identity {
    TrackId id{};
    ObservationId birth, newest;
    GlobalTime seen{};  // the newest set the track was in
    bool alive = false;
  };
  Identity& room();
  TrackId next();

  std::vector<Identity> known_;
  std::uint16_t next_ = 0;
};

}  // namespace ttf::fusion::tracks
