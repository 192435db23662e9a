#include "report/scene/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "recording/scene/geometry.h"

namespace ttf::report::scene {
namespace {

// Returns the first moment after `at`; the one before it is the newest.
template <class Part> auto after(const std::vector<Moment<Part>>& moments, TrueTime at) {
  return std::ranges::upper_bound(moments, at, {}, &Moment<Part>::at);
}

template <class Part, class Id> const Part* found(const Moment<Part>& moment, Id id) {
  const auto one = std::ranges::find(moment.parts, id, &Part::id);
  return one == moment.parts.end() ? nullptr : &*one;
}

void add_truth(const Scene& scene, TrueTime at, View& view) {
  const auto next = after(scene.truth, at);
  if (next == scene.truth.begin()) return;
  const Moment<TrueObject>& now = *std::prev(next);
  if (at - now.at > kObjectLife) return;
  view.truth = now.parts;
  if (next == scene.truth.end() || next->at - now.at > kObjectLife) return;
  const auto part = static_cast<float>((at - now.at).seconds() / (next->at - now.at).seconds());
  for (TrueObject& one : view.truth) {
    const TrueObject* later = found(*next, one.id);
    if (later == nullptr) continue;
    one.x += part * (later->x - one.x);
    one.y += part * (later->y - one.y);
    one.heading += part * std::remainder(later->heading - one.heading, 2.0f * std::numbers::pi_v<float>);
  }
}

void add_tracks(const Scene& scene, TrueTime at, View& view) {
  const auto next = after(scene.images, at);
  if (next == scene.images.begin()) return;
  const auto now = std::prev(next);
  if (at - now->at > kObjectLife) return;
  view.tracks = now->parts;
  if (const auto later = after(scene.own, now->at); later != scene.own.begin())
    view.own = std::prev(later)->parts.front();
  const double since = (at - now->at).seconds();
  for (ShownTrack& track : view.tracks) {
    std::vector<Point>& trail = view.trails.emplace_back();
    for (auto image = now; at - image->at <= kTrail; --image) {
      if (const ShownTrack* then = found(*image, track.id))
        trail.push_back({static_cast<double>(then->x), static_cast<double>(then->y)});
      if (image == scene.images.begin()) break;
    }
    std::ranges::reverse(trail);
    const Place moved = moved_on(view, track, since);
    track.x = static_cast<float>(moved.x);
    track.y = static_cast<float>(moved.y);
    track.heading = static_cast<float>(moved.heading);
  }
}

}  // namespace

Place moved_on(const View& view, const ShownTrack& track, double seconds) {
  const Place place{static_cast<double>(track.x), static_cast<double>(track.y), static_cast<double>(track.heading)};
  return recording::scene::moved_on(place, static_cast<double>(track.speed), view.own, seconds);
}

View view_at(const Scene& scene, TrueTime at) {
  View view;
  add_truth(scene, at, view);
  add_tracks(scene, at, view);
  for (const std::vector<Moment<Point>>& moments : scene.lists) {
    const auto next = after(moments, at);
    const bool seen = next != moments.begin() && at - std::prev(next)->at <= kListLife;
    view.lists.push_back(seen ? std::prev(next)->parts : std::vector<Point>{});
  }
  const auto next = after(scene.warnings, at);
  if (next == scene.warnings.begin() || at - std::prev(next)->at > kObjectLife) return view;
  for (const Warning& warning : std::prev(next)->parts)
    if (std::ranges::find(view.tracks, warning.track, &ShownTrack::id) != view.tracks.end())
      view.warnings.push_back(warning);
  return view;
}

std::string words_of(const Warning& warning) {
  if (std::isfinite(warning.time_to_collision_s))
    return fmt::format("collision in {:.1f} s", warning.time_to_collision_s);
  return std::isfinite(warning.time_gap_s) ? fmt::format("gap of {:.1f} s", warning.time_gap_s) : "warning";
}

}  // namespace ttf::report::scene
