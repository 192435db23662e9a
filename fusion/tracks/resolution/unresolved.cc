#include "fusion/tracks/resolution/unresolved.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "fusion/motion/angles.h"

namespace ttf::fusion::tracks::resolution {
namespace {

constexpr double kThree = 3.0;

// Widens the bounds by the uncertainty of the track.
ReturnBounds widened(ReturnBounds bounds, const body::SeenBox& box, const estimators::Cartesian& estimate) {
  const double range = std::max(0.1, box.centre.norm());
  const linear::Vector<2> sight = box.centre / range, left(-sight.y(), sight.x());
  const linear::Matrix<2> p = estimate.p.topLeftCorner<2, 2>(), v = estimate.p.block<2, 2>(2, 2);
  const linear::Vector<3> sigma(std::sqrt(sight.dot(p * sight)), std::sqrt(left.dot(p * left)) / range,
                                std::sqrt(sight.dot(v * sight)));
  bounds.low -= kThree * sigma;
  bounds.high += kThree * sigma;
  return bounds;
}

// Returns whether the box holds a place, which is seen from the same sensor, by more than `sigma` [m].
bool holds(const body::SeenBox& box, const linear::Vector<2>& place, double sigma) {
  const linear::Vector<2> off = place - box.centre, axis(std::cos(box.box.heading), std::sin(box.box.heading));
  return std::abs(axis.dot(off)) + sigma < 0.5 * box.box.size.x() &&
         std::abs(axis.x() * off.y() - axis.y() * off.x()) + sigma < 0.5 * box.box.size.y();
}

// Returns whether the detection lies within the bounds of both outlines together.
bool among(const sensors::Observation& z, const ReturnBounds& a, const ReturnBounds& b) {
  const double middle = 0.5 * (a.low(1) + a.high(1));
  const auto from_middle = [&](double bearing) { return motion::to_half_turn(bearing - middle); };
  const double other = from_middle(0.5 * (b.low(1) + b.high(1))), half = 0.5 * (b.high(1) - b.low(1));
  const double bearing = from_middle(z.z(1) + z.from.yaw);
  const double range_error = kThree * std::sqrt(z.r(0, 0)), bearing_error = kThree * std::sqrt(z.r(1, 1));
  const double low_rate = std::min(a.low(2), b.low(2)), high_rate = std::max(a.high(2), b.high(2));
  const double faster = std::abs(std::remainder(z.z(2) - 0.5 * (low_rate + high_rate), z.rate_span));
  return faster < 0.5 * (high_rate - low_rate) + kThree * std::sqrt(z.r(2, 2)) &&
         z.z(0) > std::min(a.low(0), b.low(0)) - range_error && z.z(0) < std::max(a.high(0), b.high(0)) + range_error &&
         bearing > std::min(a.low(1) - middle, other - half) - bearing_error &&
         bearing < std::max(a.high(1) - middle, other + half) + bearing_error;
}

}  // namespace

Unresolved::Unresolved(const config::TrackerConfig& config, std::size_t max_tracks)
    : sensors_(config.sensors), shared_(max_tracks) {
  seen_.reserve(max_tracks);
}

void Unresolved::see(const std::vector<Track>& tracks, const estimators::Estimator& estimator,
                     const parts::Visibility& visibility) {
  seen_.clear();
  largest_ = widest_ = 0.0;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (!tracks[t].confirmed || !visibility.counts(t)) continue;
    Seen& seen = seen_.emplace_back();
    seen.track = t;
    const linear::Gaussian<2> at = estimator.position(tracks[t].estimate);
    seen.at = at.x;
    widest_ = std::max(widest_, at.p.trace());
    largest_ = std::max(largest_, tracks[t].extent.size.norm());
  }
  std::sort(seen_.begin(), seen_.end(),
            [](const Seen& a, const Seen& b) { return std::tuple(a.at.x(), a.track) < std::tuple(b.at.x(), b.track); });
}

void Unresolved::share(Seen& a, Seen& b, const std::vector<Track>& tracks, const sensors::ObservationList& list,
                       const sensors::Resolution& resolution, const estimators::Estimator& estimator,
                       parts::Association& association) {
  for (Seen* seen : {&a, &b}) {
    if (seen->bounded) continue;
    seen->bounded = true;
    const Track& track = tracks[seen->track];
    seen->box = body::seen_box(track, estimator, list.observations.front().from);
    const estimators::Cartesian estimate = estimator.cartesian(track.estimate);
    seen->variance = estimate.p.topLeftCorner<2, 2>().diagonal().maxCoeff();
    seen->bounds = widened(bounds_of(seen->box), seen->box, estimate);
  }
  const double sigma = std::sqrt(a.variance + b.variance);
  if (holds(a.box, b.box.centre, sigma) || holds(b.box, a.box.centre, sigma)) return;
  if (!may_join(a.bounds, b.bounds, resolution)) return;
  bool joined = association.observation_of()[a.track] >= 0 || association.observation_of()[b.track] >= 0;
  if (!joined)
    for (std::size_t o = 0; o < list.observations.size(); ++o)
      if (!association.is_assigned(o) && among(list.observations[o], a.bounds, b.bounds)) {
        association.begin_none(o);
        joined = true;
      }
  if (!joined) return;
  any_ = true;
  shared_[a.track] = shared_[b.track] = 1;
}

// Outlines that may join have anchors within the gates, both diagonals and their errors of each other.
void Unresolved::judge(const std::vector<Track>& tracks, const sensors::ObservationList& list,
                       const estimators::Estimator& estimator, const parts::Visibility& visibility,
                       parts::Association& association) {
  any_ = false;
  const sensors::KnownSensor* sensor = sensors::known(sensors_, list.id.sensor);
  if (!sensor || !sensor->resolution || list.observations.empty() || association.is_joint()) return;
  see(tracks, estimator, visibility);
  std::fill(shared_.begin(), shared_.end(), 0);
  const sensors::Resolution& resolution = *sensor->resolution;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    for (std::size_t j = i + 1; j < seen_.size(); ++j) {
      Seen &a = seen_[i], &b = seen_[j];
      const double range = (a.at - list.observations.front().from.position).norm();
      const double near =
          2.0 * largest_ + 2.0 * kThree * std::sqrt(widest_) + resolution.range_m + resolution.across(range);
      if (b.at.x() - a.at.x() > near) break;
      if (std::abs(b.at.y() - a.at.y()) > near) continue;
      const auto observation_of = association.observation_of();
      if (observation_of[a.track] >= 0 && observation_of[b.track] >= 0) continue;
      share(a, b, tracks, list, resolution, estimator, association);
    }
  if (any_) association.withdraw(shared_, tracks, list);
}

}  // namespace ttf::fusion::tracks::resolution
