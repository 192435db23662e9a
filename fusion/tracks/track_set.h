// The tracks of an instant.
#pragma once

#include <cstddef>
#include <vector>

#include "core/time.h"
#include "fusion/tracks/track.h"

namespace ttf::fusion::tracks {

struct TrackSet {
  std::vector<Track> tracks;  // in order of birth
  GlobalTime time{};          // the time of the tracks' states
  bool started = false;

  explicit TrackSet(std::size_t capacity = 0) { tracks.reserve(capacity); }
};

}  // namespace ttf::fusion::tracks
