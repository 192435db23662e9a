#include "fusion/tracks/parts/gate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fusion/metrics/chi_square.h"
#include "fusion/tracks/parts/polar_gate.h"

namespace ttf::fusion::tracks::parts {

Gate::Gate(const config::TrackerConfig& config, std::shared_ptr<const estimators::Estimator> estimator,
           std::size_t max_tracks)
    : estimator_(std::move(estimator)), bounds_ranges_(config.filter == config::FilterKind::kExtended &&
                                                       config.motion != config::MotionModel::kInteracting &&
                                                       config.systematic == config::SystematicErrorsAre::kIgnored),
      places_(max_tracks) {
  for (int dimension = 1; dimension <= 3; ++dimension)
    gate_[dimension] = metrics::chi_square_quantile(config.gate_probability, dimension);
}

void Gate::place(const std::vector<Track>& tracks, const sensors::ObservationList& list) {
  const sensors::Observation* any = list.observations.empty() ? nullptr : &list.observations.front();
  const sensors::Mounting mounting = any ? any->from : sensors::Mounting{};
  bool centres = true;
  double variance_x = 0.0, variance_y = 0.0;
  for (const sensors::Observation& z : list.observations) {
    centres = centres && z.seen == sensors::SeenPoint::kCentre;
    if (z.kind != sensors::ObservationKind::kPosition) continue;
    variance_x = std::max(variance_x, z.r(0, 0));
    variance_y = std::max(variance_y, z.r(1, 1));
  }
  places_.begin(gate_[2]);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track& track = tracks[t];
    const linear::Gaussian<2> at =
        any ? estimator_->seen_position(track.estimate, any->sensor, any->from) : estimator_->position(track.estimate);
    const bool same = centres && track.anchor.point == sensors::SeenPoint::kCentre;
    const double reach = same ? 0.0 : reach_of(track, at.x, mounting, gate_[2]);
    places_.add({at.x(0), at.x(1), at.p(0, 0), at.p(1, 1), reach, t});
  }
  places_.arrange(variance_x, variance_y);
}

// Most pairs end here, so that the rest is out of line.
inline void Gate::try_pair(const Search& search, const sensors::Observation& seen, const linear::Vector<2>& sight,
                           std::size_t row, const association::TrackPlace& placed) const {
  const double gate = gate_[dimension_of(seen.kind)];
  const bool is_position = seen.kind == sensors::ObservationKind::kPosition;
  const auto outside = [&](double dx, double dy, double variance_x, double variance_y) {
    return dx * dx > gate * (placed.variance_x + variance_x) || dy * dy > gate * (placed.variance_y + variance_y);
  };
  const auto beyond = [&](double distance) { return std::max(0.0, std::abs(distance) - placed.reach); };
  if (is_position && outside(beyond(seen.z(0) - placed.x), beyond(seen.z(1) - placed.y), seen.r(0, 0), seen.r(1, 1)))
    return;
  const Track& track = search.tracks[placed.track];
  const sensors::Observation& z = search.referral.read(track, seen);
  const body::Distance* distance = nullptr;
  if (placed.reach > 0.0) {
    distance = search.referral.distance_of(track, placed.track, z);
    const double x = distance ? distance->between(0) : 0.0, y = distance ? distance->between(1) : 0.0;
    const double spread_x = distance ? distance->constant(0, 0) + distance->noise(0, 0) : 0.0,
                 spread_y = distance ? distance->constant(1, 1) + distance->noise(1, 1) : 0.0;
    if (is_position && outside(std::abs(z.z(0) - x - placed.x), std::abs(z.z(1) - y - placed.y), z.r(0, 0) + spread_x,
                               z.r(1, 1) + spread_y))
      return;
  }
  if (!is_position && bounds_ranges_ &&
      beyond_gate(z, sight, placed, distance, search.referral.spread_of(track, placed.track, z), gate))
    return;
  judge_pair(search, z, row, placed.track, distance);
}

[[gnu::noinline]] void Gate::judge_pair(const Search& search, const sensors::Observation& seen, std::size_t row,
                                        std::size_t column, const body::Distance* distance) const {
  const Track& track = search.tracks[column];
  const sensors::Observation& z = search.referral.expected(track, column, seen, distance);
  const double gate = gate_[dimension_of(z.kind)];
  if (search.association.is_joint()) {
    const std::optional<estimators::Fit> fit = estimator_->fit(track.estimate, z);
    if (fit && fit->distance_squared <= gate)
      search.association.offer(track, z, *fit, search.visibility.of(column), row, column);
  } else {
    const std::optional<double> squared = estimator_->distance_squared(track.estimate, z);
    if (squared && *squared <= gate) search.association.offer(track, gate, *squared, row, column);
  }
}

void Gate::search(const std::vector<Track>& tracks, const sensors::ObservationList& list, const Visibility& visibility,
                  Referral& referral, Association& association) {
  place(tracks, list);
  const Search search{tracks, visibility, referral, association};
  for (std::size_t o = 0; o < list.observations.size(); ++o) {
    const sensors::Observation& z = list.observations[o];
    linear::Vector<2> sight = linear::Vector<2>::Zero();  // positions need none
    const auto try_one = [&](const association::TrackPlace& placed) { try_pair(search, z, sight, o, placed); };
    if (z.kind == sensors::ObservationKind::kPosition) {
      places_.near({z.z(0), z.z(1), z.r(0, 0), z.r(1, 1)}, try_one);
      continue;
    }
    const double bearing = z.z(1) + z.from.yaw;
    sight << std::cos(bearing), std::sin(bearing);
    std::for_each(places_.all().begin(), places_.all().end(), try_one);
  }
}

}  // namespace ttf::fusion::tracks::parts
