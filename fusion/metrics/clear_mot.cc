#include "fusion/metrics/clear_mot.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::fusion::metrics {
namespace {

// Writes the places of `names`, in the order of the names, into `by_name`, which has room for them.
void order_by_name(std::span<const Identity> names, std::vector<std::size_t>& by_name) {
  by_name.clear();
  for (std::size_t place = 0; place < names.size(); ++place) by_name.push_back(place);
  std::sort(by_name.begin(), by_name.end(), [&](std::size_t a, std::size_t b) { return names[a] < names[b]; });
  for (std::size_t i = 1; i < by_name.size(); ++i)
    TTF_CHECK(names[by_name[i - 1]] != names[by_name[i]], "{} listed twice at one instant", names[by_name[i]]);
}

}  // namespace

ClearMot::ClearMot(const Capacity& capacity, double gate_m)
    : capacity_(capacity), gate_(gate_m), pairs_(capacity.objects, capacity.tracks) {
  TTF_CHECK(std::isfinite(gate_m) && gate_m > 0.0, "gate {} m", gate_m);
  last_.reserve(capacity.objects_ever);
  objects_by_name_.reserve(capacity.objects);
  tracks_by_name_.reserve(capacity.tracks);
  track_of_.reserve(capacity.objects);
  object_of_.reserve(capacity.tracks);
  object_names_.reserve(capacity.objects);
  track_names_.reserve(capacity.tracks);
  distances_.reserve(capacity.objects * capacity.tracks);
  matches_.reserve(std::min(capacity.objects, capacity.tracks));
}

std::span<const Match> ClearMot::step(std::span<const Named> objects, std::span<const Named> tracks) {
  TTF_CHECK(objects.size() <= capacity_.objects && tracks.size() <= capacity_.tracks, "{} objects, {} tracks",
            objects.size(), tracks.size());
  object_names_.clear();
  track_names_.clear();
  distances_.clear();
  for (const Named& object : objects) object_names_.push_back(object.name);
  for (const Named& track : tracks) track_names_.push_back(track.name);
  for (const Named& object : objects)
    for (const Named& track : tracks) distances_.push_back(distance_m(object.at, track.at));
  return step(object_names_, track_names_, distances_);
}

std::span<const Match> ClearMot::step(std::span<const Identity> objects, std::span<const Identity> tracks,
                                      std::span<const double> distances) {
  TTF_CHECK(objects.size() <= capacity_.objects && tracks.size() <= capacity_.tracks, "{} objects, {} tracks",
            objects.size(), tracks.size());
  TTF_CHECK(distances.size() == objects.size() * tracks.size(), "{} distances of {} x {}", distances.size(),
            objects.size(), tracks.size());
  order_by_name(objects, objects_by_name_);
  order_by_name(tracks, tracks_by_name_);
  ++counts_.instants;
  keep(objects, tracks, distances);
  pair_others(objects.size(), tracks.size(), distances);

  matches_.clear();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (track_of_[i] == LeastCostPairs::kNone) continue;
    const std::size_t object = objects_by_name_[i], track = tracks_by_name_[static_cast<std::size_t>(track_of_[i])];
    const Last* last = last_of(objects[object]);
    const bool switched = last != nullptr && last->track != tracks[track];
    matches_.push_back({objects[object], tracks[track], distances[object * tracks.size() + track], switched});
  }
  for (const Match& match : matches_) {
    remember(match.object, match.track);
    counts_.distance_sum_m += match.distance_m;
    counts_.switches += match.switched;
  }
  counts_.objects += objects.size();
  counts_.tracks += tracks.size();
  counts_.matches += matches_.size();
  counts_.misses += objects.size() - matches_.size();
  counts_.false_positives += tracks.size() - matches_.size();
  return matches_;
}

void ClearMot::keep(std::span<const Identity> objects, std::span<const Identity> tracks,
                    std::span<const double> distances) {
  track_of_.assign(objects.size(), LeastCostPairs::kNone);
  object_of_.assign(tracks.size(), LeastCostPairs::kNone);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Last* last = last_of(objects[objects_by_name_[i]]);
    if (last == nullptr) continue;
    const auto found = std::lower_bound(tracks_by_name_.begin(), tracks_by_name_.end(), last->track,
                                        [&](std::size_t place, Identity name) { return tracks[place] < name; });
    if (found == tracks_by_name_.end() || tracks[*found] != last->track) continue;
    if (!(distances[objects_by_name_[i] * tracks.size() + *found] <= gate_)) continue;
    int& owner = object_of_[static_cast<std::size_t>(found - tracks_by_name_.begin())];
    if (owner != LeastCostPairs::kNone) {
      const auto other = static_cast<std::size_t>(owner);
      if (last_of(objects[objects_by_name_[other]])->instant > last->instant) continue;
      track_of_[other] = LeastCostPairs::kNone;
    }
    owner = static_cast<int>(i);
    track_of_[i] = static_cast<int>(found - tracks_by_name_.begin());
  }
}

void ClearMot::pair_others(std::size_t objects, std::size_t tracks, std::span<const double> distances) {
  pairs_.begin(objects, tracks);
  for (std::size_t i = 0; i < objects; ++i)
    for (std::size_t j = 0; j < tracks; ++j) {
      if (track_of_[i] != LeastCostPairs::kNone || object_of_[j] != LeastCostPairs::kNone) continue;
      const double distance = distances[objects_by_name_[i] * tracks + tracks_by_name_[j]];
      if (distance <= gate_) pairs_.offer(i, j, distance / gate_);
    }
  pairs_.solve(LeastCostPairs::most_pairs(objects, tracks));
  for (std::size_t i = 0; i < objects; ++i)
    if (track_of_[i] == LeastCostPairs::kNone) track_of_[i] = pairs_.column_of()[i];
}

const ClearMot::Last* ClearMot::last_of(Identity object) const {
  const auto found = std::lower_bound(last_.begin(), last_.end(), object,
                                      [](const Last& last, Identity name) { return last.object < name; });
  return found != last_.end() && found->object == object ? &*found : nullptr;
}

void ClearMot::remember(Identity object, Identity track) {
  const auto place = std::lower_bound(last_.begin(), last_.end(), object,
                                      [](const Last& last, Identity name) { return last.object < name; });
  if (place != last_.end() && place->object == object) {
    *place = {object, track, counts_.instants};
    return;
  }
  TTF_CHECK(last_.size() < capacity_.objects_ever, "object {} after {} different ones", object, last_.size());
  last_.insert(place, {object, track, counts_.instants});
}

}  // namespace ttf::fusion::metrics
