#include "report/scene/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "recording/scene/geometry.h"

namespace ttf::report::scene {
namespace {

// Returns the moment that counts; null without one.
template <class Part> const Moment<Part>* newest(const std::vector<Moment<Part>>& moments, TrueTime at, Duration life) {
  const auto next = std::ranges::upper_bound(moments, at, {}, &Moment<Part>::at);
  return next == moments.begin() || at - std::prev(next)->at > life ? nullptr : &*std::prev(next);
}

template <class Part, class Id> const Part* found(const Moment<Part>& moment, Id id) {
  const auto one = std::ranges::find(moment.parts, id, &Part::id);
  return one == moment.parts.end() ? nullptr : &*one;
}

void add_truth(const Scene& scene, TrueTime at, View& view) {
  const Moment<TrueObject>* now = newest(scene.truth, at, kObjectLife);
  if (now == nullptr) return;
  view.truth = now->parts;
  if (!counts_until_next(scene.truth, static_cast<std::size_t>(now - scene.truth.data()), kObjectLife)) return;
  const Moment<TrueObject>& next = *(now + 1);
  const auto part = static_cast<float>((at - now->at).seconds() / (next.at - now->at).seconds());
  for (TrueObject& one : view.truth) {
    const TrueObject* later = found(next, one.id);
    if (later == nullptr) continue;
    one.x += part * (later->x - one.x);
    one.y += part * (later->y - one.y);
    one.heading += part * std::remainder(later->heading - one.heading, 2.0f * std::numbers::pi_v<float>);
  }
}

void add_tracks(const Scene& scene, TrueTime at, View& view) {
  const Moment<ShownTrack>* now = newest(scene.images, at, kObjectLife);
  if (now == nullptr) return;
  view.tracks = now->parts;
  if (const Moment<OwnMotion>* own = newest(scene.own, now->at, kOwnLife)) view.own = own->parts.front();
  const double since = (at - now->at).seconds();
  for (ShownTrack& track : view.tracks) {
    std::vector<Point>& trail = view.trails.emplace_back();
    for (const Moment<ShownTrack>* image = now; at - image->at <= kTrail; --image) {
      if (const ShownTrack* then = found(*image, track.id))
        trail.push_back({static_cast<double>(then->x), static_cast<double>(then->y)});
      if (image == scene.images.data()) break;
    }
    std::ranges::reverse(trail);
    const Pose moved = moved_on(view, track, since);
    track.x = static_cast<float>(moved.x);
    track.y = static_cast<float>(moved.y);
    track.heading = static_cast<float>(moved.heading);
  }
}

}  // namespace

Pose moved_on(const View& view, const ShownTrack& track, double seconds) {
  const Pose place{static_cast<double>(track.x), static_cast<double>(track.y), static_cast<double>(track.heading)};
  return recording::scene::moved_on(place, static_cast<double>(track.speed), view.own, seconds);
}

View view_at(const Scene& scene, TrueTime at) {
  View view;
  add_truth(scene, at, view);
  add_tracks(scene, at, view);
  for (const std::vector<Moment<Point>>& moments : scene.lists) {
    const Moment<Point>* list = newest(moments, at, kListLife);
    view.lists.push_back(list != nullptr ? list->parts : std::vector<Point>{});
  }
  if (const Moment<Warning>* now = newest(scene.warnings, at, kObjectLife))
    std::ranges::copy_if(now->parts, std::back_inserter(view.warnings), [&](const Warning& warning) {
      return std::ranges::find(view.tracks, warning.track, &ShownTrack::id) != view.tracks.end();
    });
  return view;
}

std::string words_of(const Warning& warning) {
  if (std::isfinite(warning.time_to_collision_s))
    return fmt::format("collision in {:.1f} s", warning.time_to_collision_s);
  return std::isfinite(warning.time_gap_s) ? fmt::format("gap of {:.1f} s", warning.time_gap_s) : "warning";
}

}  // namespace ttf::report::scene
