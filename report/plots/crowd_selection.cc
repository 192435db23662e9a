// Selects the data of a position plot of several objects. The tracks of an image belong to true objects as its judgement pairs
// them.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "fusion/metrics/object_pairs.h"
#include "report/plots/position_plot.h"
#include "report/plots/position_samples.h"

namespace ttf::report::plots {
namespace {

constexpr double kSlack = 0.1;  // s that a track may be from the nearest truth
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr fusion::metrics::Point kNowhere{kNan, kNan};

// The objects that have a track in the image of an instant.
struct Tracked {
  double t;
  std::vector<bool> objects;
};

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
    Crowd::Trail trail{object, {}, {}, {}};
    truths.push_back(by_time(samples));
    std::ranges::copy_if(truths.back(), std::back_inserter(trail.truth), [&](const Sample& s) { return inside(s.t); });
    if (trail.truth.empty())
      truths.pop_back();
    else
      crowd.trails.push_back(std::move(trail));
  }
  std::vector<Image> images = images_;
  std::ranges::stable_sort(images, {}, &Image::written);
  const auto finite = [](const Sample& s) { return std::isfinite(s.x) && std::isfinite(s.y); };
  std::vector<Tracked> tracked;
  std::vector<Sample> tracks;
  std::vector<fusion::metrics::Point> objects, estimates;
  for (const Image& image : images) {
    tracks.clear();
    estimates.clear();
    std::ranges::copy_if(image.objects, std::back_inserter(tracks), finite);
    for (const Sample& track : tracks) estimates.push_back({track.x, track.y});
    const double t = tracks.empty() ? image.written : tracks.front().t;
    objects.clear();
    for (const std::vector<Sample>& truth : truths) {
      const auto at = interpolate(truth, t, kSlack);
      objects.push_back(at ? fusion::metrics::Point{at->x, at->y} : kNowhere);
    }
    Tracked& now = tracked.emplace_back(Tracked{t, std::vector<bool>(truths.size())});
    std::vector<bool> matched(tracks.size());
    for (const fusion::metrics::ObjectPair& pair : fusion::metrics::object_pairs(objects, estimates, options_.gate_m)) {
      now.objects[pair.truth] = matched[pair.estimate] = true;
      if (!crowd.dense() && inside(tracks[pair.estimate].t))
        crowd.trails[pair.truth].track.push_back(tracks[pair.estimate]);
    }
    for (std::size_t i = 0; i < tracks.size(); ++i)
      if ((crowd.dense() || !matched[i]) && inside(tracks[i].t)) crowd.tracks.push_back(tracks[i]);
  }
  std::ranges::stable_sort(tracked, {}, &Tracked::t);
  for (std::size_t o = 0; o < crowd.trails.size(); ++o)
    for (const Sample& s : crowd.trails[o].truth) {
      const auto next = std::ranges::upper_bound(tracked, s.t + kSlack, {}, &Tracked::t);
      crowd.trails[o].missed.push_back(next == tracked.begin() || !std::prev(next)->objects[o]);
    }
  return crowd;
}

}  // namespace ttf::report::plots
