#include "fusion/tracks/identities.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::fusion::tracks {

// Every living track may have a name; as many dead ones may return to life.
Identities::Identities(std::size_t max_tracks) { known_.reserve(2 * max_tracks); }

void Identities::name(TrackSet& set, GlobalTime oldest) {
  for (Identity& identity : known_) identity.alive = false;
  const auto take = [&](Identity& identity, Track& track) {
    identity.birth = track.birth;
    identity.newest = track.newest;
    identity.seen = set.time;
    identity.alive = true;
    track.id = identity.id;
  };
  for (Track& track : set.tracks) {
    track.id = kNoTrack;
    const auto same =
        std::find_if(known_.begin(), known_.end(), [&](const Identity& i) { return i.birth == track.birth; });
    if (same != known_.end()) take(*same, track);
  }
  for (Track& track : set.tracks) {
    if (track.id != kNoTrack) continue;
    const auto moved = std::find_if(known_.begin(), known_.end(),
                                    [&](const Identity& i) { return !i.alive && i.newest == track.newest; });
    if (moved != known_.end()) take(*moved, track);
  }
  std::erase_if(known_, [&](const Identity& i) { return !i.alive && i.seen < oldest; });
  for (Track& track : set.tracks) {
    if (track.id != kNoTrack || !track.confirmed) continue;
    Identity& identity = room();
    identity.id = next();
    take(identity, track);
  }
}

Identities::Identity& Identities::room() {
  if (known_.size() == known_.capacity()) {
    const auto longest_dead = std::min_element(known_.begin(), known_.end(), [](const Identity& a, const Identity& b) {
      return a.alive != b.alive ? b.alive : a.seen < b.seen;
    });
    TTF_CHECK(!longest_dead->alive, "{} tracks alive", known_.size());
    known_.erase(longest_dead);
  }
  return known_.emplace_back();
}

TrackId Identities::next() {
  const auto taken = [&](TrackId id) {
    return id == kNoTrack ||
           std::any_of(known_.begin(), known_.end(), [&](const Identity& i) { return i.alive && i.id == id; });
  };
  while (taken(static_cast<TrackId>(next_))) ++next_;
  return static_cast<TrackId>(next_++);
}

}  // namespace ttf::fusion::tracks
