#include "fusion/tracks/tracker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/motion/angles.h"
#include "fusion/tracks/anchoring.h"
#include "fusion/tracks/existence.h"
#include "fusion/tracks/overlaps.h"
#include "fusion/tracks/polar_gate.h"

namespace ttf::fusion::tracks {
namespace {

void correct_scalar(Scalar& scalar, double innovation, double measured, double sigma) {
  const double variance = sigma * sigma;
  if (!scalar.known) {
    scalar = {measured, variance, true};
    return;
  }
  const double gain = scalar.variance / (scalar.variance + variance);
  scalar.value += gain * innovation;
  scalar.variance = (1.0 - gain) * (1.0 - gain) * scalar.variance + gain * gain * variance;
}

// Makes confirmed tracks take precedence over tentative ones for the same observation.
constexpr double kConfirmedBonus = 100.0;

// Returns whether this velocity can tell nothing new of the front. So most tracks need no covariance.
bool remembers_front(const Heading& heading, const linear::Vector<2>& velocity) {
  const double ahead = std::cos(heading.value) * velocity.x() + std::sin(heading.value) * velocity.y();
  return !heading.known || heading.front * ahead > 0.0;
}

// A silhouette is no fixed place of its object.
bool gives_way(const Anchor& anchor, sensors::SeenPoint seen) {
  return anchor.point == sensors::SeenPoint::kSilhouette && seen != sensors::SeenPoint::kCentre &&
         seen != sensors::SeenPoint::kSilhouette;
}

int lists_elsewhere_before(sensors::SeenPoint seen) {
  return seen == sensors::SeenPoint::kSilhouette ? kListsBeforeSilhouette : kListsElsewhere;
}

}  // namespace

Tracker::Tracker(const config::TrackerConfig& config, std::size_t max_observations)
    : config_(config), estimator_(estimators::make_estimator(config)), max_observations_(max_observations),
      max_tracks_(static_cast<std::size_t>(config.max_objects) + 3 * max_observations),
      assignment_(max_observations, max_tracks_), places_(max_tracks_), distances_(max_tracks_), spreads_(max_tracks_),
      joint_(config.association == config::Association::kJpda ? max_observations : 0,
             config.association == config::Association::kJpda ? max_tracks_ : 0),
      twins_(config, max_tracks_), visibility_(config, max_tracks_), taken_(max_observations),
      near_track_(max_observations), observation_of_(max_tracks_) {
  bounds_ranges_ = config.filter == config::FilterKind::kExtended &&
                   config.motion != config::MotionModel::kInteracting &&
                   config.systematic == config::SystematicErrorsAre::kIgnored;
  candidates_.reserve(max_observations * max_tracks_);
  squares_.reserve(max_observations * max_tracks_);
  if (config.association == config::Association::kJpda) {
    pairs_.reserve(max_observations * max_tracks_);
    explanations_.reserve(max_observations + 1);
    explained_.reserve(max_observations);
  }
  for (int dimension = 1; dimension <= 3; ++dimension)
    gate_[dimension] = metrics::chi_square_quantile(config.gate_probability, dimension);
}

void Tracker::step(TrackSet& set, const sensors::ObservationList& list) {
  if (!set.started) {
    set.started = true;
    set.time = list.measured;
  }
  const double dt = (list.measured - set.time).seconds();
  const HeadingStep turn(config_, dt);
  for (Track& track : set.tracks) predict(track, turn, dt);
  set.time = list.measured;
  std::erase_if(set.tracks,
                [&](const Track& track) { return given_up(track, set.time, set.time, config_, *estimator_); });
  take_in(set, list);
}

// Each track is predicted where its copy is, while it is near.
void Tracker::step(const TrackSet& before, TrackSet& after, const sensors::ObservationList& list) {
  TTF_CHECK(before.tracks.size() <= after.tracks.capacity(), "{} tracks into {}", before.tracks.size(),
            after.tracks.capacity());
  after.time = list.measured;
  after.started = true;
  after.tracks.clear();
  const double dt = before.started ? (list.measured - before.time).seconds() : 0.0;
  const HeadingStep turn(config_, dt);
  for (const Track& track : before.tracks) {
    Track& copy = after.tracks.emplace_back(track);
    predict(copy, turn, dt);
    if (given_up(copy, after.time, after.time, config_, *estimator_)) after.tracks.pop_back();
  }
  take_in(after, list);
}

// Takes the list in at its instant.
void Tracker::take_in(TrackSet& set, const sensors::ObservationList& list) {
  TTF_CHECK(list.observations.size() <= max_observations_, "{} observations", list.observations.size());
  associate(set, list);
  for (std::size_t t = 0; t < set.tracks.size(); ++t) {
    Track& track = set.tracks[t];
    const int observation = observation_of_[t];
    if (list_counts(t)) {
      ++track.lists;
      track.hits = (track.hits << 1) | (observation >= 0 ? 1u : 0u);
      track.misses = observation >= 0 ? 0 : track.misses + 1;
    }
    const sensors::Observation* z =
        observation >= 0 ? &list.observations[static_cast<std::size_t>(observation)] : nullptr;
    track.doubtful = (track.doubtful << 1) | (z && z->weight < sensors::kSureWeight ? 1u : 0u);
    if (z) track.newest = {list.id, static_cast<std::uint16_t>(observation), list.measured};
    const bool joint = config_.association == config::Association::kJpda;
    if (!joint && config_.birth == config::Birth::kExistence) judge_existence(track, t, z, visibility_.of(t));
    const sensors::Observation* counts = nullptr;
    if (z) {
      correct_heading(track, *z);
      if (z->has_heading) {
        distances_.forget(t);
        spreads_.forget(t);
      }
      counts = &refer(track, t, *z, static_cast<std::size_t>(observation));
      distances_.forget(t);
    }
    if (joint)
      take_in_all(track, t, list);
    else if (counts)
      estimator_->update(track.estimate, *counts);
    if (!z) continue;
    if (!remembers_front(track.heading, estimator_->velocity(track.estimate)))
      learn_front(track.heading, estimators::velocity_of(estimator_->cartesian(track.estimate)));
    correct_extent(track, *z);
    carry(track.unfiltered, *z);
  }
  give_birth(set, list);
  prune(set);
  if (config_.merge_probability > 0.0) twins_.unite(set.tracks, list, *estimator_);
}

std::span<const int> Tracker::assigned(const TrackSet& set, const sensors::ObservationList& list) {
  TTF_CHECK(list.observations.size() <= max_observations_, "{} observations", list.observations.size());
  associate(set, list);
  return std::span(observation_of_).first(set.tracks.size());
}

void Tracker::predict(Track& track, const HeadingStep& turn, double dt) const {
  estimator_->predict(track.estimate, dt);
  track.heading = turn.of(track.heading, estimator_->velocity(track.estimate).norm());
  track.shown = predicted(track.shown, kTurningSilhouette, dt);
  tracks::predict(track.extent, config_.extent_noise, dt);
  if (config_.birth == config::Birth::kExistence) track.existence = survived(track.existence, dt, config_);
}

void Tracker::place(const TrackSet& set, const sensors::ObservationList& list) {
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
  for (std::size_t t = 0; t < set.tracks.size(); ++t) {
    const Track& track = set.tracks[t];
    const linear::Gaussian<2> at =
        any ? estimator_->seen_position(track.estimate, any->sensor, any->from) : estimator_->position(track.estimate);
    const bool same = centres && track.anchor.point == sensors::SeenPoint::kCentre;
    const double reach = same ? 0.0 : reach_of(track, at.x, mounting, gate_[2]);
    places_.add({at.x(0), at.x(1), at.p(0, 0), at.p(1, 1), reach, t});
  }
  places_.arrange(variance_x, variance_y);
}

void Tracker::sum_innovations(const TrackSet& set, const sensors::ObservationList& list) {
  innovations_ = {};
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const auto column = static_cast<std::size_t>(candidates_[c].column);
    if (observation_of_[column] != candidates_[c].row || !set.tracks[column].confirmed) continue;
    const sensors::Observation& z = list.observations[static_cast<std::size_t>(candidates_[c].row)];
    innovations_.squares += squares_[c];
    innovations_.degrees += static_cast<std::uint32_t>(dimension_of(z.kind));
  }
}

// Outside the gate on one axis means outside the gate. This cheap bound comes first: with the track's reach, and then with
// the distance of the observed point from its anchor. Most pairs end here, so that the rest is out of line.
inline void Tracker::try_pair(const TrackSet& set, const sensors::Observation& z, const linear::Vector<2>& sight,
                              std::size_t row, const association::Place& placed) {
  const sensors::Mounting& mounting = z.from;
  const double gate = gate_[dimension_of(z.kind)];
  const bool is_position = z.kind == sensors::ObservationKind::kPosition;
  const auto outside = [&](double dx, double dy, double variance_x, double variance_y) {
    return dx * dx > gate * (placed.variance_x + variance_x) || dy * dy > gate * (placed.variance_y + variance_y);
  };
  const auto beyond = [&](double distance) { return std::max(0.0, std::abs(distance) - placed.reach); };
  if (is_position && outside(beyond(z.z(0) - placed.x), beyond(z.z(1) - placed.y), z.r(0, 0), z.r(1, 1))) return;
  const Distance* distance = nullptr;
  if (placed.reach > 0.0) {
    distance = distances_.of(placed.track, set.tracks[placed.track], *estimator_, z, mounting);
    const double x = distance ? distance->between(0) : 0.0, y = distance ? distance->between(1) : 0.0;
    const double spread_x = distance ? distance->constant(0, 0) + distance->noise(0, 0) : 0.0,
                 spread_y = distance ? distance->constant(1, 1) + distance->noise(1, 1) : 0.0;
    if (is_position && outside(std::abs(z.z(0) - x - placed.x), std::abs(z.z(1) - y - placed.y), z.r(0, 0) + spread_x,
                               z.r(1, 1) + spread_y))
      return;
  }
  if (!is_position && bounds_ranges_) {
    const linear::Matrix<3>* spread =
        z.returns > 0 ? &spreads_.of(placed.track, set.tracks[placed.track], *estimator_, mounting) : nullptr;
    if (beyond_gate(z, sight, placed, distance, spread, gate)) return;
  }
  judge_pair(set.tracks[placed.track], z, row, static_cast<int>(placed.track), distance, mounting);
}

[[gnu::noinline]] void Tracker::judge_pair(const Track& track, const sensors::Observation& seen, std::size_t row,
                                           int column, const Distance* distance, const sensors::Mounting& mounting) {
  const std::optional<sensors::Observation> spread = spread_on(track, static_cast<std::size_t>(column), seen);
  const sensors::Observation& z = spread ? *spread : seen;
  std::optional<sensors::Observation> moved;
  if (distance) moved = expected(z, *distance, mounting);
  const sensors::Observation& as_anchor = moved ? *moved : z;
  if (config_.association == config::Association::kJpda) {
    offer(track, as_anchor, static_cast<int>(row), column);
    return;
  }
  const double gate = gate_[dimension_of(z.kind)];
  const std::optional<double> distance_squared = estimator_->distance_squared(track.estimate, as_anchor);
  if (!distance_squared || !(*distance_squared <= gate)) return;
  if (track.confirmed) near_track_[row] = 1;
  // Never zero: a pair on the gate's edge still beats no pair.
  const double gain = gate - *distance_squared + 1e-9 + (track.confirmed ? kConfirmedBonus : 0.0);
  candidates_.push_back({static_cast<int>(row), column, gain});
  squares_.push_back(*distance_squared);
}

// The order of candidates does not change the assignment.
void Tracker::associate(const TrackSet& set, const sensors::ObservationList& list) {
  candidates_.clear();
  squares_.clear();
  pairs_.clear();
  std::fill(near_track_.begin(), near_track_.end(), 0);
  const bool joint = config_.association == config::Association::kJpda;
  const bool weighs_all = joint || config_.birth == config::Birth::kExistence;
  if (weighs_all) visibility_.judge(set.tracks, *estimator_, list.id.sensor, {}, list.vehicle);
  place(set, list);
  distances_.begin(set.tracks.size());
  spreads_.begin();
  for (std::size_t o = 0; o < list.observations.size(); ++o) {
    const sensors::Observation& z = list.observations[o];
    linear::Vector<2> sight = linear::Vector<2>::Zero();  // positions need none
    const auto try_one = [&](const association::Place& placed) { try_pair(set, z, sight, o, placed); };
    if (z.kind == sensors::ObservationKind::kPosition) {
      places_.near({z.z(0), z.z(1), z.r(0, 0), z.r(1, 1)}, try_one);
      continue;
    }
    const double bearing = z.z(1) + z.from.yaw;
    sight << std::cos(bearing), std::sin(bearing);
    std::for_each(places_.all().begin(), places_.all().end(), try_one);
  }
  assignment_.solve(candidates_, list.observations.size(), set.tracks.size());
  if (joint) joint_.solve(pairs_, list.observations.size(), set.tracks.size());
  std::fill(observation_of_.begin(), observation_of_.end(), -1);
  const auto columns = assignment_.column_of();
  for (std::size_t o = 0; o < columns.size(); ++o)
    if (columns[o] >= 0) observation_of_[static_cast<std::size_t>(columns[o])] = static_cast<int>(o);
  if (!weighs_all) visibility_.judge(set.tracks, *estimator_, list.id.sensor, observation_of_, list.vehicle);
  sum_innovations(set, list);
}

// Offers a pair. The most probable joint event has the largest product of weights; it contains no pair that is
// less probable than both alone.
void Tracker::offer(const Track& track, const sensors::Observation& z, int row, int column) {
  const std::optional<estimators::Fit> fit = estimator_->fit(track.estimate, z);
  if (!fit || !(fit->distance_squared <= gate_[dimension_of(z.kind)])) return;
  if (track.confirmed) near_track_[static_cast<std::size_t>(row)] = 1;
  const double visible = visibility_.of(static_cast<std::size_t>(column));
  const double ratio = likelihood_ratio(z, fit->density, config_, visible);
  const double weight = joint_weight(track.existence, ratio, config_, visible);
  pairs_.push_back({row, column, weight});
  if (!(weight > 1.0)) return;
  candidates_.push_back({row, column, std::log(weight)});
  squares_.push_back(fit->distance_squared);
}

// Updates the existence from the prediction, before the update of the estimate.
void Tracker::judge_existence(Track& track, std::size_t column, const sensors::Observation* z, double visible) {
  double ratio = 0.0;
  if (z) {
    const Distance* distance = distance_of(track, column, *z);
    const std::optional<sensors::Observation> spread = spread_on(track, column, *z);
    const sensors::Observation& seen = spread ? *spread : *z;
    const std::optional<estimators::Fit> fit =
        estimator_->fit(track.estimate, distance ? expected(seen, *distance, z->from) : seen);
    if (fit) ratio = likelihood_ratio(*z, fit->density, config_, visible);
  }
  track.existence = after_list(track.existence, ratio, config_, visible);
}

const Distance* Tracker::distance_of(const Track& track, std::size_t column, const sensors::Observation& z) {
  return distances_.of(column, track, *estimator_, z, z.from);
}

sensors::Observation Tracker::referred(const Track& track, const sensors::Observation& z) const {
  const std::optional<Distance> distance = distance_of(track, z);
  const std::optional<sensors::Observation> spread = spread_on(track, z);
  const sensors::Observation& seen = spread ? *spread : z;
  return distance ? counted(seen, *distance, z.from, estimator_->position(track.estimate).p) : seen;
}

void Tracker::count_elsewhere(Track& track, const sensors::Observation& z, const Distance& distance, bool moves,
                              Referred& taken) const {
  taken.elsewhere = true;
  taken.moved = moves;
  if (moves) {
    taken.displacement = {distance.between, distance.constant + distance.noise};
    estimators::displace(track.estimate, taken.displacement);
    track.anchor = distance.to;
    track.lists_elsewhere = 0;
    return;
  }
  const linear::Gaussian<2> at = estimator_->position(track.estimate);
  learn_size(track.extent, z, distance, at);
  taken.counted = counted(z, distance, z.from, at.p);
}

void Tracker::count_spread(const std::optional<sensors::Observation>& spread, Referred& taken) {
  if (!spread) return;
  if (!taken.elsewhere || taken.moved) taken.counted = *spread;
  taken.spread = true;
}

Tracker::Referred Tracker::referred_late(Track& then, const sensors::Observation& z, bool may_move) const {
  const std::optional<Distance> distance = distance_of(then, z);
  const std::optional<sensors::Observation> spread = spread_on(then, z);
  Referred taken{.from = then.anchor};
  if (distance)
    count_elsewhere(then, spread ? *spread : z, *distance, may_move && gives_way(then.anchor, z.seen), taken);
  count_spread(spread, taken);
  return taken;
}

// Refers the track's observation to its anchor, or moves the anchor to the observed point.
const sensors::Observation& Tracker::refer(Track& track, std::size_t column, const sensors::Observation& z,
                                           std::size_t row) {
  const Distance* distance = distance_of(track, column, z);
  // A write that is not read is left out: it takes time.
  Referred& taken = taken_[row];
  taken.elsewhere = taken.moved = taken.spread = false;
  taken.from = track.anchor;
  const std::optional<sensors::Observation> spread = spread_on(track, column, z);
  track.lists_elsewhere = distance ? static_cast<std::uint8_t>(track.lists_elsewhere + 1) : 0;
  if (distance)
    count_elsewhere(track, spread ? *spread : z, *distance,
                    gives_way(track.anchor, z.seen) || track.lists_elsewhere >= lists_elsewhere_before(z.seen), taken);
  else if (z.seen == sensors::SeenPoint::kSilhouette)
    track.anchor.from = z.from.position;
  count_spread(spread, taken);
  return taken.of(z);
}

// Updates by all observations in the track's gate, with their probabilities given that its object exists.
void Tracker::take_in_all(Track& track, std::size_t column, const sensors::ObservationList& list) {
  const double unseen = joint_.none_of_column(column) * exists_unseen(track.existence, config_, visibility_.of(column));
  double exists = unseen;
  for (const association::JointAssociation::Shared& shared : joint_.of_column(column)) exists += shared.probability;
  if (!(exists > 0.0)) return;  // a long lost track without any observation
  explanations_.clear();
  explained_.clear();
  explanations_.push_back({nullptr, unseen / exists});
  for (const association::JointAssociation::Shared& shared : joint_.of_column(column)) {
    explained_.push_back(referred(track, list.observations[static_cast<std::size_t>(shared.row)]));
    explanations_.push_back({&explained_.back(), shared.probability / exists});
  }
  if (explanations_.size() > 1) estimator_->update(track.estimate, explanations_);
  if (config_.birth == config::Birth::kExistence) track.existence = std::min(1.0, exists);
}

void Tracker::correct_heading(Track& track, const sensors::Observation& z, double age) const {
  if (!z.has_heading) return;
  const linear::Vector<2> v = estimator_->velocity(track.estimate);
  correct(track.heading, z.heading, z.sigma_heading, v.norm() > 1.0 ? std::atan2(v.y(), v.x()) : z.heading, age);
}

// Corrects the extent. The span needs the aspect, so it comes last, after position, course and axis.
void Tracker::correct_extent(Track& track, const sensors::Observation& z) const {
  if (z.has_length) correct_length(track.extent, z.length, z.sigma_length);
  if (z.has_width) correct_width(track.extent, z.width, z.sigma_width);
  if (!z.has_span) return;
  const double seen_from = (z.z.head<2>() - z.from.position).norm();
  const double shown = z.span * seen_from;
  correct_scalar(track.shown, shown - track.shown.value, shown, z.sigma_span * seen_from);
  const CentrePosition now = centre_position(track, estimator_->cartesian(track.estimate));
  const linear::Vector<2>& from = z.from.position;
  const double x = now.estimate.x(0) - from.x(), y = now.estimate.x(1) - from.y(), range = std::hypot(x, y);
  if (range <= 0.0) return;
  const Facing& facing = now.facing;
  const Eigen::Vector2d sight(x / range, y / range);
  const double range_variance = sight.dot(now.estimate.p * sight);
  correct_span(
      track.extent,
      {range, std::sqrt(range_variance), motion::to_half_turn(facing.heading - std::atan2(y, x)), facing.sigma}, z.span,
      z.sigma_span);
}

// An unassigned observation becomes a tentative track, unless it lies in the gate of a confirmed one: there it
// is a second echo of a known object.
void Tracker::give_birth(TrackSet& set, const sensors::ObservationList& list) {
  const auto columns = assignment_.column_of();
  for (std::size_t o = 0; o < list.observations.size(); ++o) {
    if (columns[o] >= 0 || near_track_[o] || set.tracks.size() == max_tracks_) continue;
    const sensors::Observation& z = list.observations[o];
    const bool by_existence = config_.birth == config::Birth::kExistence;
    if (!by_existence && z.weight < sensors::kSureWeight) continue;
    Track track;
    track.birth = track.newest = {list.id, static_cast<std::uint16_t>(o), list.measured};
    track.extent = Extent(config_.sizes);
    track.estimate = estimator_->initial(z.returns > 0 ? with_spread(z, track.extent) : z);
    track.anchor = first_anchor(z, z.from);
    track.heading = unknown_heading(config_);
    if (z.has_heading) correct(track.heading, z.heading, z.sigma_heading, z.heading);
    correct_extent(track, z);
    carry(track.unfiltered, z);
    track.hits = 1;
    track.lists = 1;
    if (by_existence) track.existence = config_.initial_existence * z.weight;
    set.tracks.push_back(track);
  }
}

void Tracker::prune(TrackSet& set) const {
  const std::uint32_t window = config_.confirm_window >= 32 ? ~0u : (1u << config_.confirm_window) - 1u;
  const bool by_existence = config_.birth == config::Birth::kExistence;
  auto confirmed = std::count_if(set.tracks.begin(), set.tracks.end(), [](const Track& t) { return t.confirmed; });
  for (Track& track : set.tracks)
    if (!track.confirmed && confirmed < config_.max_objects &&
        (by_existence ? track.existence >= config_.confirm_existence
                      : std::popcount(track.hits & ~track.doubtful & window) >= config_.confirm_hits) &&
        (!config_.end_overlaps.value_or(false) ||
         !overlaps_confirmed(set.tracks, track, set.time, config_, *estimator_))) {
      track.confirmed = true;
      ++confirmed;
    }
  const double largest = config_.delete_position_sigma * config_.delete_position_sigma;
  std::erase_if(set.tracks, [&](const Track& track) {
    if (estimator_->position(track.estimate).p.diagonal().maxCoeff() > largest) return track.misses > 0;
    if (by_existence) return track.existence < config_.delete_existence;
    if (track.confirmed) return track.misses >= config_.delete_misses;
    // A tentative track ends when M hits are out of reach within its window.
    const int hits = std::popcount(track.hits & ~track.doubtful & window);
    const int left = config_.confirm_window - std::min(track.lists, config_.confirm_window);
    return hits + left < config_.confirm_hits;
  });
  if (config_.end_overlaps.value_or(false)) end_overlaps(set.tracks, set.time, config_, *estimator_);
}

}  // namespace ttf::fusion::tracks
