#include "fusion/tracks/parts/association.h"

#include <algorithm>
#include <cmath>

#include "fusion/tracks/parts/existence.h"

namespace ttf::fusion::tracks::parts {
namespace {

// Makes confirmed tracks take precedence over tentative ones for the same observation.
constexpr double kConfirmedBonus = 100.0;

}  // namespace

Association::Association(const config::TrackerConfig& config, std::size_t max_observations, std::size_t max_tracks)
    : config_(config), assignment_(max_observations, max_tracks),
      joint_(is_joint() ? max_observations : 0, is_joint() ? max_tracks : 0), near_confirmed_(max_observations),
      observation_of_(max_tracks) {
  candidates_.reserve(max_observations * max_tracks);
  squares_.reserve(max_observations * max_tracks);
  if (is_joint()) pairs_.reserve(max_observations * max_tracks);
}

void Association::begin() {
  candidates_.clear();
  squares_.clear();
  pairs_.clear();
  std::fill(near_confirmed_.begin(), near_confirmed_.end(), 0);
}

void Association::offer(const Track& track, double gate, double distance_squared, std::size_t row, std::size_t column) {
  if (track.confirmed) near_confirmed_[row] = 1;
  // Never zero: a pair on the gate's edge still beats no pair.
  const double gain = gate - distance_squared + 1e-9 + (track.confirmed ? kConfirmedBonus : 0.0);
  candidates_.push_back({static_cast<int>(row), static_cast<int>(column), gain});
  squares_.push_back(distance_squared);
}

void Association::offer(const Track& track, const sensors::Observation& z, const estimators::Fit& fit, double visible,
                        std::size_t row, std::size_t column) {
  if (track.confirmed) near_confirmed_[row] = 1;
  const double ratio = likelihood_ratio(z, fit.density, config_, visible);
  const double weight = joint_weight(track.existence, ratio, config_, visible);
  pairs_.push_back({static_cast<int>(row), static_cast<int>(column), weight});
  if (!(weight > 1.0)) return;
  candidates_.push_back({static_cast<int>(row), static_cast<int>(column), std::log(weight)});
  squares_.push_back(fit.distance_squared);
}

void Association::solve(const std::vector<Track>& tracks, const sensors::ObservationList& list) {
  assignment_.solve(candidates_, list.observations.size(), tracks.size());
  if (is_joint()) joint_.solve(pairs_, list.observations.size(), tracks.size());
  std::fill(observation_of_.begin(), observation_of_.end(), -1);
  const auto columns = assignment_.column_of();
  for (std::size_t o = 0; o < columns.size(); ++o)
    if (columns[o] >= 0) observation_of_[static_cast<std::size_t>(columns[o])] = static_cast<int>(o);
  sum_innovations(tracks, list);
}

void Association::withdraw(std::span<const char> marked, const std::vector<Track>& tracks,
                           const sensors::ObservationList& list) {
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (marked[t]) observation_of_[t] = -1;
  sum_innovations(tracks, list);
}

void Association::sum_innovations(const std::vector<Track>& tracks, const sensors::ObservationList& list) {
  innovations_ = {};
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const auto column = static_cast<std::size_t>(candidates_[c].column);
    if (observation_of_[column] != candidates_[c].row || !tracks[column].confirmed) continue;
    const sensors::Observation& z = list.observations[static_cast<std::size_t>(candidates_[c].row)];
    innovations_.squares += squares_[c];
    innovations_.degrees += static_cast<std::uint32_t>(dimension_of(z.kind));
  }
}

}  // namespace ttf::fusion::tracks::parts
