#include "evaluation/accuracy/tracking_judge.h"

#include <algorithm>

namespace ttf::evaluation::accuracy {
namespace {

using fusion::metrics::Identity;
using fusion::metrics::Named;
using fusion::metrics::Point;

// Copies the positions, and the first of each name in the names' order.
void copy(std::span<const Named> all, std::vector<Point>& points, std::vector<Named>& named) {
  points.clear();
  for (const Named& one : all) points.push_back(one.at);
  named.assign(all.begin(), all.end());
  std::stable_sort(named.begin(), named.end(), [](const Named& a, const Named& b) { return a.name < b.name; });
  named.erase(std::unique(named.begin(), named.end(), [](const Named& a, const Named& b) { return a.name == b.name; }),
              named.end());
}

}  // namespace

TrackingJudge::TrackingJudge(const fusion::metrics::CutOff& cut_off, double gate_m)
    : gate_(gate_m), metric_(cut_off), mot_(gate_m) {}

void TrackingJudge::judge(TrueTime at, std::span<const Named> objects, std::span<const Named> tracks) {
  if (last_ && at <= *last_) return;
  last_ = at;
  ++instants_;
  copy(objects, points_[0], named_[0]);
  copy(tracks, points_[1], named_[1]);
  const fusion::metrics::SetDistance distance = metric_.between(points_[0], points_[1]);
  gospa_.localisation += distance.gospa.localisation;
  gospa_.missed += distance.gospa.missed;
  gospa_.false_estimates += distance.gospa.false_estimates;
  ospa_.localisation += distance.ospa.localisation;
  ospa_.cardinality += distance.ospa.cardinality;
  objects_.clear();
  for (const Named& object : named_[0]) objects_.push_back(object.name);
  lives_.step(at, objects_, mot_.step(named_[0], named_[1]));
}

TrackingMeasures TrackingJudge::measures() const {
  TrackingMeasures all;
  all.cut_off = metric_.cut_off();
  all.gate_m = gate_;
  all.instants = instants_;
  all.mot = mot_.counts();
  all.lives = lives_.summary();
  if (instants_ == 0) return all;
  const auto n = static_cast<double>(instants_);
  all.gospa = {0.0, gospa_.localisation / n, gospa_.missed / n, gospa_.false_estimates / n};
  all.gospa.distance_m = metric_.root(all.gospa.localisation + all.gospa.missed + all.gospa.false_estimates);
  all.ospa = {0.0, ospa_.localisation / n, ospa_.cardinality / n};
  all.ospa.distance_m = metric_.root(all.ospa.localisation + all.ospa.cardinality);
  return all;
}

}  // namespace ttf::evaluation::accuracy
