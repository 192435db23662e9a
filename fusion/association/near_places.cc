#include "fusion/association/near_places.h"

namespace ttf::fusion::association {
namespace {

// So many places are searched faster along x alone.
constexpr std::size_t kFew = 64;

}  // namespace

NearPlaces::NearPlaces(std::size_t most) {
  by_track_.reserve(most);
  places_.reserve(most);
  along_x_.reserve(most);
  strips_.reserve(static_cast<std::size_t>(std::sqrt(static_cast<double>(most))) + 3);
}

void NearPlaces::clear() {
  by_track_.clear();
  largest_variance_x_ = largest_variance_y_ = largest_reach_ = 0.0;
}

void NearPlaces::sort() {
  if (along_x_.size() != by_track_.size()) {
    along_x_.clear();
    for (std::size_t t = 0; t < by_track_.size(); ++t) along_x_.push_back({0.0, t});
  }
  for (Along& along : along_x_) along.x = by_track_[along.track].x;
  std::sort(along_x_.begin(), along_x_.end(),
            [](const Along& a, const Along& b) { return a.x != b.x ? a.x < b.x : a.track < b.track; });
  places_.clear();
  for (const Along& along : along_x_) places_.push_back(by_track_[along.track]);
  strips_.clear();
  if (places_.size() <= kFew) return;
  const auto length = static_cast<std::size_t>(std::sqrt(static_cast<double>(places_.size())));
  for (std::size_t begin = 0; begin < places_.size(); begin += length) {
    const std::size_t end = std::min(begin + length, places_.size());
    strips_.push_back({places_[begin].x, places_[end - 1].x, begin, end});
    std::sort(places_.begin() + static_cast<std::ptrdiff_t>(begin), places_.begin() + static_cast<std::ptrdiff_t>(end),
              [](const Place& a, const Place& b) { return a.y != b.y ? a.y < b.y : a.track < b.track; });
  }
}

}  // namespace ttf::fusion::association
