#include "fusion/tracks/parts/confirmation.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>

#include "fusion/tracks/parts/overlaps.h"

namespace ttf::fusion::tracks::parts {
namespace {

int sure_hits(const Life& life, const config::TrackerConfig& config) {
  const std::uint32_t window = config.confirm_window >= 32 ? ~0u : (1u << config.confirm_window) - 1u;
  return std::popcount(life.hits & ~life.doubtful & window);
}

bool is_believed(const Life& life, const config::TrackerConfig& config) {
  if (config.birth == config::Birth::kExistence) return life.existence >= config.confirm_existence;
  return sure_hits(life, config) >= config.confirm_hits;
}

bool has_ended(const Track& track, const config::TrackerConfig& config, const estimators::Estimator& estimator) {
  const double largest = config.delete_position_sigma * config.delete_position_sigma;
  if (estimator.position(track.estimate).p.diagonal().maxCoeff() > largest) return track.misses > 0;
  if (config.birth == config::Birth::kExistence) return track.existence < config.delete_existence;
  if (track.confirmed) return track.misses >= config.delete_misses;
  const int left = config.confirm_window - std::min(track.lists, config.confirm_window);
  return sure_hits(track, config) + left < config.confirm_hits;
}

// The younger track goes on with the identity of the elder one.
void take_place(Track& elder, const Track& younger) {
  const TrackId id = elder.id;
  const ObservationId birth = elder.birth;
  elder = younger;
  elder.id = id;
  elder.birth = birth;
  elder.confirmed = true;
}

}  // namespace

void confirm_and_end(TrackSet& set, const config::TrackerConfig& config, const estimators::Estimator& estimator,
                     Overlaps& overlaps) {
  const bool none_overlap = config.end_overlaps.value_or(false);
  auto confirmed = std::count_if(set.tracks.begin(), set.tracks.end(), [](const Track& t) { return t.confirmed; });
  for (std::size_t t = 0; t < set.tracks.size(); ++t) {
    Track& track = set.tracks[t];
    if (track.confirmed || confirmed >= config.max_objects || !is_believed(track, config)) continue;
    const std::optional<std::size_t> other =
        none_overlap ? overlaps.confirmed_in_place_of(set.tracks, t, set.time, config, estimator) : std::nullopt;
    if (other && set.tracks[*other].newest.measured < track.birth.measured) {
      take_place(set.tracks[*other], track);
      set.tracks.erase(set.tracks.begin() + static_cast<std::ptrdiff_t>(t--));
    }
    if (other) continue;
    track.confirmed = true;
    ++confirmed;
  }
  std::erase_if(set.tracks, [&](const Track& track) { return has_ended(track, config, estimator); });
  if (none_overlap) overlaps.end(set.tracks, set.time, config, estimator);
}

}  // namespace ttf::fusion::tracks::parts
