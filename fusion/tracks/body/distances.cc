#include "fusion/tracks/body/distances.h"

#include <algorithm>
#include <cmath>

#include "fusion/tracks/body/turn.h"

namespace ttf::fusion::tracks::body {
namespace {

using sensors::SeenPoint;

bool has_sides(SeenPoint seen) { return seen != SeenPoint::kCentre && seen != SeenPoint::kSilhouette; }

// Without the track's heading, that of the observation counts. Where a range and a bearing point, the mounting tells. The face of an
// outermost point counts, too.
bool is_its_own(const sensors::Observation& z, const Body& body) {
  if (!body.heading.known) return z.has_heading || has_sides(z.seen);
  return has_sides(z.seen) && (is_outermost(z.seen) || z.kind != sensors::ObservationKind::kPosition);
}

}  // namespace

// The heading adds at most 0.35 of the diagonal. A sure one adds less: a point of the outline swings by at most the diagonal
// for each radian, and the mean depth of a silhouette changes by L^2 / (2 W) at most. Near a sensor there may be no silhouette.
double reach_of(const Body& body, const linear::Vector<2>& at, const sensors::Mounting& mounting, double gate) {
  const linear::Vector<2>& size = body.extent.size;
  const double squared = size.squaredNorm(), diagonal = std::sqrt(squared), length = size.maxCoeff();
  double by_heading = 0.35 * diagonal;
  const bool sure = body.heading.known && body.heading.variance <= kSureHeading * kSureHeading;
  const double from_sensor = std::min((at - mounting.position).squaredNorm(), (at - body.anchor.from).squaredNorm());
  if (sure && from_sensor > 4.0 * squared)
    by_heading =
        std::min(by_heading, std::sqrt(body.heading.variance) * (diagonal + length * length / (2.0 * size.minCoeff())));
  return diagonal + std::sqrt(gate) * (by_heading + std::sqrt(body.extent.covariance.trace()));
}

void Distances::begin(std::size_t tracks) {
  for (std::size_t t = 0; t < tracks; ++t) forget(t);
}

const Distance* Distances::computed(std::size_t index, const Body& body, const estimators::Estimator& estimator,
                                    const sensors::Observation& z, const sensors::Mounting& mounting) {
  if (is_its_own(z, body)) {
    single_ = distance_to(body, estimator, z, mounting);
    return single_ ? &*single_ : nullptr;
  }
  OfTrack& known = of_track_[index];
  if (has_sides(z.seen) && !has_[index].axis) {
    known.axis << std::cos(body.heading.value), std::sin(body.heading.value);
    has_[index].axis = true;
  }
  Anchor to = anchor_of(z.seen, z.z.head<2>(), known.axis, mounting.position);
  if (z.seen == SeenPoint::kSilhouette) to.sensor = z.sensor;
  if (to == body.anchor) return nullptr;
  if (!has_[index].distance || !(to == known.distance.to)) {
    known.distance = *distance_to(body, estimator, z, mounting);
    has_[index].distance = true;
  }
  return &known.distance;
}

}  // namespace ttf::fusion::tracks::body
