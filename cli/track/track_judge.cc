#include "cli/track/track_judge.h"

#include <cmath>
#include <utility>

#include "evaluation/accuracy/plane.h"
#include "fusion/metrics/object_pairs.h"

namespace ttf::cli::track {

using evaluation::accuracy::kGate_m;
using fusion::metrics::Named;

TrackJudge::TrackJudge(const std::vector<recording::rows::ObservationRow>& rows, const fusion::metrics::CutOff& cut_off)
    : truth_(rows), judge_(cut_off, kGate_m) {}

// Without any track no instant of the state is known: the fusion's is taken.
void TrackJudge::take(GlobalTime known, std::span<const fusion::tracks::TrackView> tracks) {
  if (truth_.empty()) return;
  if (waiting_ && waiting_->known != known) judge(*waiting_);
  Shown& shown = waiting_.emplace(Shown{});
  shown.known = known;
  shown.at = tracks.empty() ? known : tracks.front().valid_at;
  for (const fusion::tracks::TrackView& track : tracks) {
    shown.tracks.push_back(
        {static_cast<fusion::metrics::Identity>(index_of(track.id)), {track.state(0), track.state(1)}});
    shown.velocities.push_back({track.state(2), track.state(3)});
  }
}

void TrackJudge::judge(const Shown& shown) {
  const std::vector<recording::replay::TrueObject> truths = truth_.at(shown.at);
  std::vector<Named> objects;
  std::vector<fusion::metrics::Point> is, seen;
  for (const recording::replay::TrueObject& object : truths) objects.push_back(object.is), is.push_back(object.is.at);
  for (const Named& track : shown.tracks) seen.push_back(track.at);
  judge_.judge(TrueTime{shown.known.ns}, objects, shown.tracks);
  const std::vector<fusion::metrics::ObjectPair> pairs = fusion::metrics::object_pairs(is, seen, kGate_m);
  sums_.compared += pairs.size();
  sums_.missed += is.size() - pairs.size();
  sums_.spurious += seen.size() - pairs.size();
  for (const fusion::metrics::ObjectPair& pair : pairs) {
    const recording::replay::TrueObject& truth = truths[pair.truth];
    const auto& [vx, vy] = shown.velocities[pair.estimate];
    position_squares_ += std::pow(distance_m(is[pair.truth], seen[pair.estimate]), 2);
    velocity_squares_ += std::pow(vx - truth.vx, 2) + std::pow(vy - truth.vy, 2);
  }
}

std::optional<TrackAccuracy> TrackJudge::finish() {
  if (truth_.empty()) return std::nullopt;
  if (waiting_) judge(*waiting_);
  waiting_.reset();
  sums_.tracking = judge_.measures();
  if (sums_.compared > 0) {
    const auto n = static_cast<double>(sums_.compared);
    sums_.position_rmse_m = std::sqrt(position_squares_ / n);
    sums_.velocity_rmse_mps = std::sqrt(velocity_squares_ / n);
  }
  return std::move(sums_);
}

}  // namespace ttf::cli::track
