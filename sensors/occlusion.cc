#include "sensors/occlusion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "sensors/shape.h"

namespace ttf::sensors {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();
// Far above rounding, for objects no nearer than twice their reach.
constexpr double kMarginRad = 1e-9, kMargin_m = 1e-6;

}  // namespace

bool hides(const ObjectState& object, double bearing, double range, double shadow) {
  // A cheap bound, no tighter than rounding: the line of sight passes the centre beyond the outline's reach.
  const double across = -std::sin(bearing) * object.x + std::cos(bearing) * object.y;
  if (std::abs(across) > 0.5 * (object.length + object.width) + kMargin_m) return false;
  const auto distance = RayTarget(object).ray_to(bearing);
  return distance && *distance < range && range < *distance * (1.0 + shadow);
}

Occlusion::Occlusion(std::size_t most_objects)
    : most_(most_objects), leaves_(std::bit_ceil(std::max<std::size_t>(most_objects, 1))) {
  for (std::vector<Mark>* marks : {&by_distance_, &by_low_, &by_high_, &by_bearing_}) marks->reserve(most_);
  place_.resize(most_);
  crossed_.resize(2 * leaves_);
  hidden_.resize(most_);
}

std::span<const char> Occlusion::hidden(std::span<const ObjectState> objects, std::span<const Sight> sights,
                                        double shadow) {
  TTF_CHECK(objects.size() <= most_ && sights.size() == objects.size(), "{} objects, {} sights", objects.size(),
            sights.size());
  tried_ = 0;
  std::fill_n(hidden_.begin(), objects.size(), 0);
  mark(objects, sights);
  std::fill(crossed_.begin(), crossed_.end(), 0);
  auto low = by_low_.begin(), high = by_high_.begin();
  for (const Mark& line : by_bearing_) {
    for (; low != by_low_.end() && low->at <= line.at; ++low) set_crossed(place_[low->object], true);
    for (; high != by_high_.end() && high->at < line.at; ++high) set_crossed(place_[high->object], false);
    hidden_[line.object] = is_hidden(objects, line.object, sights[line.object], shadow) ? 1 : 0;
  }
  return {hidden_.data(), objects.size()};
}

void Occlusion::sort(std::vector<Mark>& marks) {
  std::sort(marks.begin(), marks.end(),
            [](const Mark& a, const Mark& b) { return a.at != b.at ? a.at < b.at : a.object < b.object; });
}

void Occlusion::mark(std::span<const ObjectState> objects, std::span<const Sight> sights) {
  for (std::vector<Mark>* marks : {&by_distance_, &by_low_, &by_high_, &by_bearing_}) marks->clear();
  reach_ = 0.0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Sight& sight = sights[i];
    const double reach = 0.5 * (objects[i].length + objects[i].width),
                 distance = std::hypot(objects[i].x, objects[i].y);
    const bool bounded = sight.has_silhouette && distance > 2.0 * reach;
    const double half = bounded ? sight.half_width + kMarginRad : kEverywhere;
    reach_ = std::max(reach_, reach);
    by_distance_.push_back({distance, i});
    by_low_.push_back({sight.bearing - half, i});
    by_high_.push_back({sight.bearing + half, i});
    if (sight.wanted) by_bearing_.push_back({sight.bearing, i});
  }
  sort(by_distance_);
  sort(by_low_);
  sort(by_high_);
  sort(by_bearing_);
  for (std::size_t place = 0; place < by_distance_.size(); ++place) place_[by_distance_[place].object] = place;
}

void Occlusion::set_crossed(std::size_t place, bool crossed) {
  std::size_t node = leaves_ + place;
  crossed_[node] = crossed ? 1 : 0;
  for (node /= 2; node > 0; node /= 2) crossed_[node] = crossed_[2 * node] | crossed_[2 * node + 1];
}

// Returns the first such place from `from` on, or the number of leaves.
std::size_t Occlusion::next_crossed(std::size_t from) const {
  if (from >= leaves_) return leaves_;
  std::size_t node = leaves_ + from;
  while (!crossed_[node]) {
    while (node % 2 == 1) node /= 2;  // a right child: what follows is further up
    if (node == 0) return leaves_;
    ++node;
  }
  while (node < leaves_) node = crossed_[2 * node] ? 2 * node : 2 * node + 1;
  return node - leaves_;
}

// The nearest come first: behind a near object all is hidden, unless its shadow ends.
bool Occlusion::is_hidden(std::span<const ObjectState> objects, std::size_t object, const Sight& sight, double shadow) {
  const double from = sight.range / (1.0 + shadow) - reach_ - kMargin_m, to = sight.range + reach_ + kMargin_m;
  const auto first =
      std::partition_point(by_distance_.begin(), by_distance_.end(), [&](const Mark& mark) { return mark.at < from; });
  for (auto place = next_crossed(static_cast<std::size_t>(first - by_distance_.begin()));
       place < by_distance_.size() && by_distance_[place].at <= to; place = next_crossed(place + 1)) {
    const ObjectState& other = objects[by_distance_[place].object];
    if (other.id == objects[object].id) continue;
    ++tried_;
    if (hides(other, sight.bearing, sight.range, shadow)) return true;
  }
  return false;
}

}  // namespace ttf::sensors
