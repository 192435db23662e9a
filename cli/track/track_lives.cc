#include "cli/track/track_lives.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ttf::cli::track {

void TrackLives::take(std::span<const fusion::tracks::TrackView> tracks) {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto [life, is_new] = lives_.emplace(tracks[i].id, std::pair(tracks[i].valid_at, tracks[i].valid_at));
    life->second.second = std::max(life->second.second, tracks[i].valid_at);
    for (std::size_t j = 0; j < i; ++j) {
      if (!(fusion::tracks::overlap_depth(footprint_of(tracks[i]), footprint_of(tracks[j])) > 0.0)) continue;
      ++overlaps_;
      pairs_.insert(std::minmax(tracks[i].id, tracks[j].id));
    }
  }
}

LivesSummary TrackLives::summary() const {
  LivesSummary summary{lives_.size(), pairs_.size(), overlaps_, {}};
  std::vector<double> seconds;
  for (const auto& life : lives_) seconds.push_back((life.second.second - life.second.first).seconds());
  std::sort(seconds.begin(), seconds.end());
  // Between order statistics by linear interpolation (Hyndman and Fan's type 7).
  for (std::size_t q = 0; q < 3 && !seconds.empty(); ++q) {
    const double place = 0.25 * static_cast<double>((q + 1) * (seconds.size() - 1));
    const auto below = static_cast<std::size_t>(place);
    const double above = seconds[std::min(below + 1, seconds.size() - 1)];
    summary.lifetimes_s[q] = seconds[below] + (place - static_cast<double>(below)) * (above - seconds[below]);
  }
  return summary;
}

}  // namespace ttf::cli::track
