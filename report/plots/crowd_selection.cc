// Selects the data of a position plot of several objects: each track of an image belongs to the nearest true object.
#include <algorithm>
#include <cmath>
#include <utility>

#include "report/plots/position_plot.h"
#include "report/plots/position_samples.h"

namespace ttf::report::plots {
namespace {

constexpr double kSlack = 0.1;  // s that a track may be from the nearest truth

}  // namespace

bool PositionPlots::several() const {
  if (options_.object) return false;
  const auto in_window = [&](const auto& one) {
    return std::ranges::any_of(one.second, [&](const Sample& s) { return inside(s.t); });
  };
  return std::ranges::count_if(truths_, in_window) > 1;
}

PositionPlots::Crowd PositionPlots::crowd() const {
  Crowd crowd;
  std::vector<std::vector<Sample>> truths;  // with their ends outside the window
  for (const auto& [object, samples] : truths_) {
    Crowd::Trail trail{object, {}, {}};
    truths.push_back(by_time(samples));
    std::ranges::copy_if(truths.back(), std::back_inserter(trail.truth), [&](const Sample& s) { return inside(s.t); });
    if (trail.truth.empty())
      truths.pop_back();
    else
      crowd.trails.push_back(std::move(trail));
  }
  std::vector<Image> images = images_;
  std::ranges::stable_sort(images, {}, &Image::written);
  const auto shown = [&](const Sample& s) { return inside(s.t) && std::isfinite(s.x) && std::isfinite(s.y); };
  if (crowd.dense()) {
    for (const Image& image : images) std::ranges::copy_if(image.objects, std::back_inserter(crowd.tracks), shown);
    return crowd;
  }
  struct Pair {
    double distance;
    std::size_t object, track;
  };
  std::vector<Pair> pairs;
  std::vector<bool> objects, tracks;
  for (const Image& image : images) {
    pairs.clear();
    for (std::size_t t = 0; t < image.objects.size(); ++t) {
      const Sample& track = image.objects[t];
      if (!shown(track)) continue;
      for (std::size_t o = 0; o < truths.size(); ++o)
        if (const auto at = interpolate(truths[o], track.t, kSlack))
          if (const double d = std::hypot(track.x - at->x, track.y - at->y); d <= options_.gate_m)
            pairs.push_back({d, o, t});
    }
    std::ranges::stable_sort(pairs, {}, &Pair::distance);
    objects.assign(truths.size(), false);
    tracks.assign(image.objects.size(), false);
    for (const Pair& pair : pairs) {
      if (objects[pair.object] || tracks[pair.track]) continue;
      objects[pair.object] = tracks[pair.track] = true;
      crowd.trails[pair.object].track.push_back(image.objects[pair.track]);
    }
    for (std::size_t t = 0; t < image.objects.size(); ++t)
      if (!tracks[t] && shown(image.objects[t])) crowd.tracks.push_back(image.objects[t]);
  }
  return crowd;
}

}  // namespace ttf::report::plots
