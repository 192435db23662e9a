#include "fusion/metrics/clear_mot.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/check.h"
#include "core/ids.h"

namespace ttf::fusion::metrics {
namespace {

// Writes the names in their order into `ordered`, and the place of each there into `place_of`.
void order_by_name(std::span<const Identity> names, std::vector<Identity>& ordered,
                   std::vector<std::size_t>& place_of) {
  ordered.assign(names.begin(), names.end());
  std::sort(ordered.begin(), ordered.end());
  for (std::size_t i = 1; i < ordered.size(); ++i)
    TTF_CHECK(ordered[i - 1] != ordered[i], "{} listed twice at one instant", ordered[i]);
  place_of.clear();
  for (const Identity name : names)
    place_of.push_back(
        static_cast<std::size_t>(std::lower_bound(ordered.begin(), ordered.end(), name) - ordered.begin()));
}

}  // namespace

ClearMot::ClearMot(double gate_m) : gate_(gate_m) {
  TTF_CHECK(std::isfinite(gate_m) && gate_m > 0.0, "gate {} m", gate_m);
}

std::span<const Match> ClearMot::step(std::span<const Named> objects, std::span<const Named> tracks) {
  for (const int side : {0, 1}) {
    names_[side].clear();
    points_[side].clear();
    for (const Named& one : side == 0 ? objects : tracks) {
      names_[side].push_back(one.name);
      points_[side].push_back(one.at);
    }
  }
  begin(names_[0], names_[1]);
  for (const NearPair& pair : near_pairs_.find(points_[0], points_[1], gate_))
    near_.push_back({of_object_[pair.row], of_track_[pair.column], pair.distance_m});
  return judge();
}

std::span<const Match> ClearMot::step(std::span<const Identity> objects, std::span<const Identity> tracks,
                                      std::span<const double> distances) {
  TTF_CHECK(distances.size() == objects.size() * tracks.size(), "{} distances of {} x {}", distances.size(),
            objects.size(), tracks.size());
  begin(objects, tracks);
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (std::size_t j = 0; j < tracks.size(); ++j)
      if (const double distance = distances[i * tracks.size() + j]; distance <= gate_)
        near_.push_back({of_object_[i], of_track_[j], distance});
  return judge();
}

void ClearMot::begin(std::span<const Identity> objects, std::span<const Identity> tracks) {
  order_by_name(objects, objects_, of_object_);
  order_by_name(tracks, tracks_, of_track_);
  near_.clear();
}

std::span<const Match> ClearMot::judge() {
  ++counts_.instants;
  std::sort(near_.begin(), near_.end(),
            [](const Near& a, const Near& b) { return std::tie(a.object, a.track) < std::tie(b.object, b.track); });
  track_of_.assign(objects_.size(), SparsePairs::kNone);
  object_of_.assign(tracks_.size(), SparsePairs::kNone);
  distance_of_.assign(objects_.size(), 0.0);
  keep();
  pair_others();

  matches_.clear();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (track_of_[i] == SparsePairs::kNone) continue;
    const Identity track = tracks_[index_of(track_of_[i])];
    const Last* last = last_of(objects_[i]);
    matches_.push_back({objects_[i], track, distance_of_[i], last != nullptr && last->track != track});
  }
  for (const Match& match : matches_) {
    remember(match.object, match.track);
    counts_.distance_sum_m += match.distance_m;
    counts_.switches += match.switched;
  }
  counts_.objects += objects_.size();
  counts_.tracks += tracks_.size();
  counts_.matches += matches_.size();
  counts_.misses += objects_.size() - matches_.size();
  counts_.false_positives += tracks_.size() - matches_.size();
  return matches_;
}

void ClearMot::keep() {
  for (const Near& near : near_) {
    const Last* last = last_of(objects_[near.object]);
    if (last == nullptr || last->track != tracks_[near.track]) continue;
    int& owner = object_of_[near.track];
    if (owner != SparsePairs::kNone) {
      if (last_of(objects_[index_of(owner)])->instant > last->instant) continue;
      track_of_[index_of(owner)] = SparsePairs::kNone;
    }
    owner = static_cast<int>(near.object);
    track_of_[near.object] = static_cast<int>(near.track);
    distance_of_[near.object] = near.distance_m;
  }
}

void ClearMot::pair_others() {
  pairs_.begin(objects_.size(), tracks_.size());
  for (const Near& near : near_)
    if (track_of_[near.object] == SparsePairs::kNone && object_of_[near.track] == SparsePairs::kNone)
      pairs_.offer(near.object, near.track, near.distance_m / gate_);
  pairs_.solve(Best::kMostPairs);
  for (const Near& near : near_) {
    if (pairs_.column_of()[near.object] != static_cast<int>(near.track)) continue;
    track_of_[near.object] = static_cast<int>(near.track);
    distance_of_[near.object] = near.distance_m;
  }
}

const ClearMot::Last* ClearMot::last_of(Identity object) const {
  const auto found = std::lower_bound(last_.begin(), last_.end(), object,
                                      [](const Last& last, Identity name) { return last.object < name; });
  return found != last_.end() && found->object == object ? &*found : nullptr;
}

void ClearMot::remember(Identity object, Identity track) {
  const auto place = std::lower_bound(last_.begin(), last_.end(), object,
                                      [](const Last& last, Identity name) { return last.object < name; });
  if (place != last_.end() && place->object == object)
    *place = {object, track, counts_.instants};
  else
    last_.insert(place, {object, track, counts_.instants});
}

}  // namespace ttf::fusion::metrics
