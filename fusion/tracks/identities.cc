#include "fusion/tracks/identities.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/check.h"

namespace ttf::fusion::tracks {
namespace {

constexpr std::uint64_t kGone = std::numeric_limits<std::uint64_t>::max();

// The order of a set's tracks: that of the lists, and within a list that of the observations.
bool precedes(const ObservationId& a, const ObservationId& b) {
  return std::tie(a.measured, a.measurement, a.index) < std::tie(b.measured, b.measurement, b.index);
}

}  // namespace

// Every living track may have a name; as many dead ones may return to life.
Identities::Identities(std::size_t max_tracks) : most_(2 * max_tracks) {
  known_.reserve(most_);
  dead_.reserve(most_);
}

void Identities::name(TrackSet& set, GlobalTime oldest) {
  for (Identity& identity : known_) identity.alive = false;
  if (name_by_birth(set) < set.tracks.size()) name_by_newest(set);
  std::erase_if(known_, [&](const Identity& i) { return !i.alive && i.seen < oldest; });
  name_confirmed(set);
  put_in_order();
}

void Identities::take(Identity& identity, Track& track, GlobalTime now) {
  identity.birth = track.birth;
  identity.newest = track.newest;
  identity.seen = now;
  identity.alive = true;
  track.id = identity.id;
}

// Returns how many tracks have got their names. Mostly the next identity is the next track's.
std::size_t Identities::name_by_birth(TrackSet& set) {
  std::size_t count = 0;
  auto at = known_.begin();
  for (Track& track : set.tracks) {
    track.id = kNoTrack;
    if (at == known_.end() || at->birth != track.birth)
      at = std::lower_bound(known_.begin(), known_.end(), track.birth,
                            [](const Identity& i, const ObservationId& birth) { return precedes(i.birth, birth); });
    if (at == known_.end() || at->birth != track.birth) continue;
    take(*at, track, set.time);
    ++at;
    ++count;
  }
  return count;
}

// If several have the same newest observation, the first one named is taken.
void Identities::name_by_newest(TrackSet& set) {
  list_dead();
  if (dead_.empty()) return;
  std::sort(dead_.begin(), dead_.end(), [](const Dead& a, const Dead& b) {
    return a.newest != b.newest ? precedes(a.newest, b.newest) : a.number < b.number;
  });
  for (Track& track : set.tracks) {
    if (track.id != kNoTrack) continue;
    auto dead = std::lower_bound(dead_.begin(), dead_.end(), track.newest,
                                 [](const Dead& d, const ObservationId& newest) { return precedes(d.newest, newest); });
    while (dead != dead_.end() && dead->newest == track.newest && known_[dead->index].alive) ++dead;
    if (dead != dead_.end() && dead->newest == track.newest) take(known_[dead->index], track, set.time);
  }
}

void Identities::list_dead() {
  dead_.clear();
  for (std::size_t i = 0; i < known_.size(); ++i)
    if (const Identity& known = known_[i]; !known.alive) dead_.push_back({known.newest, known.seen, known.number, i});
}

void Identities::name_confirmed(TrackSet& set) {
  const auto is_new = [](const Track& track) { return track.id == kNoTrack && track.confirmed; };
  const auto count = static_cast<std::size_t>(std::count_if(set.tracks.begin(), set.tracks.end(), is_new));
  if (count == 0) return;
  make_room(count);
  taken_.reset();
  taken_.set(index_of(kNoTrack));
  for (const Identity& identity : known_)
    if (identity.alive) taken_.set(index_of(identity.id));
  for (Track& track : set.tracks) {
    if (!is_new(track)) continue;
    while (taken_[next_]) ++next_;
    taken_.set(next_);
    Identity& identity = known_.emplace_back();
    identity.id = static_cast<TrackId>(next_++);
    identity.number = named_++;
    take(identity, track, set.time);
  }
}

// Forgets the longest dead.
void Identities::make_room(std::size_t count) {
  if (known_.size() + count <= most_) return;
  const std::size_t too_many = known_.size() + count - most_;
  list_dead();
  TTF_CHECK(dead_.size() >= too_many, "{} tracks alive", known_.size() - dead_.size() + count);
  std::sort(dead_.begin(), dead_.end(),
            [](const Dead& a, const Dead& b) { return std::tie(a.seen, a.number) < std::tie(b.seen, b.number); });
  for (std::size_t i = 0; i < too_many; ++i) known_[dead_[i].index].number = kGone;
  std::erase_if(known_, [](const Identity& identity) { return identity.number == kGone; });
}

void Identities::put_in_order() {
  const auto precede = [](const Identity& a, const Identity& b) {
    return a.birth != b.birth ? precedes(a.birth, b.birth) : a.number < b.number;
  };
  if (!std::is_sorted(known_.begin(), known_.end(), precede)) std::sort(known_.begin(), known_.end(), precede);
}

}  // namespace ttf::fusion::tracks
