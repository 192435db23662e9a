#include "fusion/tracks/parts/referral.h"

#include <utility>

namespace ttf::fusion::tracks::parts {
namespace {

using sensors::SeenPoint;

// A silhouette is no fixed place of its object.
bool gives_way(const body::Anchor& anchor, SeenPoint seen) {
  return anchor.point == SeenPoint::kSilhouette && seen != SeenPoint::kCentre && seen != SeenPoint::kSilhouette;
}

int lists_elsewhere_before(SeenPoint seen) {
  return seen == SeenPoint::kSilhouette ? kListsBeforeSilhouette : kListsElsewhere;
}

std::optional<sensors::Observation> spread_on(const Track& track, const estimators::Estimator& estimator,
                                              const sensors::Observation& z) {
  if (z.returns == 0) return std::nullopt;
  return with_spread(z, track, estimator, z.from);
}

void count_elsewhere(Track& track, const estimators::Estimator& estimator, const sensors::Observation& z,
                     const body::Distance& distance, bool moves, Referred& taken) {
  taken.elsewhere = true;
  taken.moved = moves;
  if (moves) {
    taken.displacement = {distance.between, distance.constant + distance.noise};
    estimators::displace(track.estimate, taken.displacement);
    track.anchor = distance.to;
    track.lists_elsewhere = 0;
    return;
  }
  const linear::Gaussian<2> at = estimator.position(track.estimate);
  correct_size(track.extent, z, distance, at);
  taken.counted = counted(z, distance, z.from, at.p);
}

// `spread` is the observation with the spread of its returns, or null.
void count_spread(const sensors::Observation* spread, Referred& taken) {
  if (!spread) return;
  if (!taken.elsewhere || taken.moved) taken.counted = *spread;
  taken.spread = true;
}

}  // namespace

Referred referred_late(Track& then, const estimators::Estimator& estimator, const sensors::Observation& z,
                       bool may_move) {
  const std::optional<body::Distance> distance = distance_to(then, estimator, z, z.from);
  const std::optional<sensors::Observation> spread = spread_on(then, estimator, z);
  Referred taken{.from = then.anchor};
  if (distance)
    count_elsewhere(then, estimator, spread ? *spread : z, *distance,
                    may_move && !distance->is_vague && gives_way(then.anchor, z.seen), taken);
  count_spread(spread ? &*spread : nullptr, taken);
  return taken;
}

sensors::Observation referred(const Track& track, const estimators::Estimator& estimator,
                              const sensors::Observation& z) {
  const std::optional<body::Distance> distance = distance_to(track, estimator, z, z.from);
  const std::optional<sensors::Observation> spread = spread_on(track, estimator, z);
  const sensors::Observation& seen = spread ? *spread : z;
  return distance ? counted(seen, *distance, z.from, estimator.position(track.estimate).p) : seen;
}

Referral::Referral(std::shared_ptr<const estimators::Estimator> estimator, std::size_t max_observations,
                   std::size_t max_tracks, bool reads_both)
    : estimator_(std::move(estimator)), distances_(max_tracks), spreads_(max_tracks), taken_(max_observations),
      reads_both_(reads_both) {}

void Referral::begin(std::size_t tracks) {
  distances_.begin(tracks);
  spreads_.begin();
}

void Referral::forget(std::size_t column) {
  distances_.forget(column);
  spreads_.forget(column);
}

const sensors::Observation& Referral::expected(const Track& track, std::size_t column, const sensors::Observation& z,
                                               const body::Distance* distance) {
  const sensors::Observation* seen = &z;
  if (const linear::Matrix<3>* spread = spread_of(track, column, z))
    seen = &spread_.emplace(body::with_spread(z, *spread));
  if (distance) seen = &moved_.emplace(body::expected(*seen, *distance, z.from));
  return *seen;
}

const sensors::Observation& Referral::refer(Track& track, std::size_t column, const sensors::Observation& z,
                                            std::size_t row) {
  const body::Distance* distance = distance_of(track, column, z);
  // A write that is not read is left out: it takes time.
  Referred& taken = taken_[row];
  taken.elsewhere = taken.moved = taken.spread = false;
  taken.from = track.anchor;
  const sensors::Observation* spread = nullptr;
  if (const linear::Matrix<3>* of_returns = spread_of(track, column, z))
    spread = &spread_.emplace(body::with_spread(z, *of_returns));
  if (!distance || !distance->is_vague)
    track.lists_elsewhere = distance ? static_cast<std::uint8_t>(track.lists_elsewhere + 1) : 0;
  if (distance)
    count_elsewhere(track, *estimator_, spread ? *spread : z, *distance,
                    !distance->is_vague &&
                        (gives_way(track.anchor, z.seen) || track.lists_elsewhere >= lists_elsewhere_before(z.seen)),
                    taken);
  else if (z.seen == SeenPoint::kSilhouette)
    track.anchor.from = z.from.position;
  count_spread(spread, taken);
  distances_.forget(column);
  return taken.of(z);
}

}  // namespace ttf::fusion::tracks::parts
