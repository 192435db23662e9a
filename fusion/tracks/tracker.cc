#include "fusion/tracks/tracker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "fusion/metrics/chi_square.h"
#include "fusion/motion/angles.h"
#include "fusion/tracks/existence.h"

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

// So many tracks are searched faster along x alone.
constexpr std::size_t kFewTracks = 64;

// Makes a rounded bound exclude no pair inside a gate.
constexpr double kRoundedUp = 1.0 + 1e-12;

}  // namespace

Tracker::Tracker(const config::TrackerConfig& config, std::size_t max_observations)
    : config_(config), estimator_(estimators::make_estimator(config)), max_observations_(max_observations),
      max_tracks_(static_cast<std::size_t>(config.max_objects) + 3 * max_observations),
      assignment_(max_observations, max_tracks_),
      joint_(config.association == config::Association::kJpda ? max_observations : 0,
             config.association == config::Association::kJpda ? max_tracks_ : 0),
      twins_(config, max_tracks_), near_track_(max_observations), observation_of_(max_tracks_) {
  candidates_.reserve(max_observations * max_tracks_);
  placed_.reserve(max_tracks_);
  strips_.reserve(static_cast<std::size_t>(std::sqrt(static_cast<double>(max_tracks_))) + 3);
  if (config.association == config::Association::kJpda) {
    pairs_.reserve(max_observations * max_tracks_);
    explanations_.reserve(max_observations + 1);
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
  for (Track& track : set.tracks) predict(track, dt);
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
  for (const Track& track : before.tracks) {
    Track& copy = after.tracks.emplace_back(track);
    predict(copy, dt);
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
    ++track.lists;
    track.hits = (track.hits << 1) | (observation >= 0 ? 1u : 0u);
    track.misses = observation >= 0 ? 0 : track.misses + 1;
    const sensors::Observation* z =
        observation >= 0 ? &list.observations[static_cast<std::size_t>(observation)] : nullptr;
    if (z) track.newest = {list.id, static_cast<std::uint16_t>(observation), list.measured};
    if (config_.association == config::Association::kJpda) {
      take_in_all(track, t, list);
      if (z) correct_beside(track, *z);
      continue;
    }
    if (config_.birth == config::Birth::kExistence) judge_existence(track, z);
    if (z) {
      estimator_->update(track.estimate, *z);
      correct_beside(track, *z);
    }
  }
  give_birth(set, list);
  prune(set);
  if (config_.merge_probability > 0.0) twins_.unite(set.tracks, *estimator_);
}

std::span<const int> Tracker::assigned(const TrackSet& set, const sensors::ObservationList& list) {
  TTF_CHECK(list.observations.size() <= max_observations_, "{} observations", list.observations.size());
  associate(set, list);
  return std::span(observation_of_).first(set.tracks.size());
}

void Tracker::predict(Track& track, double dt) const {
  estimator_->predict(track.estimate, dt);
  track.heading = predicted(track.heading, config_.heading_noise, dt);
  tracks::predict(track.extent, config_.extent_noise, dt);
  if (config_.birth == config::Birth::kExistence) track.existence = survived(track.existence, dt, config_);
}

// Strips are as long as many, so that a search passes few of either.
void Tracker::place(const TrackSet& set, SensorId seen_by) {
  placed_.clear();
  strips_.clear();
  largest_variance_x_ = largest_variance_y_ = 0.0;
  for (std::size_t t = 0; t < set.tracks.size(); ++t) {
    const linear::Gaussian<2> at = estimator_->seen_position(set.tracks[t].estimate, seen_by);
    placed_.push_back({at.x(0), at.x(1), at.p(0, 0), at.p(1, 1), t});
    largest_variance_x_ = std::max(largest_variance_x_, at.p(0, 0));
    largest_variance_y_ = std::max(largest_variance_y_, at.p(1, 1));
  }
  std::sort(placed_.begin(), placed_.end(),
            [](const Placed& a, const Placed& b) { return a.x != b.x ? a.x < b.x : a.track < b.track; });
  if (placed_.size() <= kFewTracks) return;
  const auto length = static_cast<std::size_t>(std::sqrt(static_cast<double>(placed_.size())));
  for (std::size_t begin = 0; begin < placed_.size(); begin += length) {
    const std::size_t end = std::min(begin + length, placed_.size());
    strips_.push_back({placed_[begin].x, placed_[end - 1].x, begin, end});
    std::sort(placed_.begin() + static_cast<std::ptrdiff_t>(begin), placed_.begin() + static_cast<std::ptrdiff_t>(end),
              [](const Placed& a, const Placed& b) { return a.y != b.y ? a.y < b.y : a.track < b.track; });
  }
}

// Tries the tracks that are not beyond the reach of the least certain one, on either axis: all others are outside of
// every gate.
template <class Try> void Tracker::near(const sensors::Observation& z, double gate, const Try& try_one) const {
  const double reach_x = kRoundedUp * std::sqrt(gate * (largest_variance_x_ + z.r(0, 0)));
  const double low = z.z(0) - reach_x, high = z.z(0) + reach_x;
  if (strips_.empty()) {
    auto at = std::partition_point(placed_.begin(), placed_.end(), [&](const Placed& p) { return p.x < low; });
    for (; at != placed_.end() && at->x <= high; ++at) try_one(*at);
    return;
  }
  const double reach_y = kRoundedUp * std::sqrt(gate * (largest_variance_y_ + z.r(1, 1)));
  auto strip = std::partition_point(strips_.begin(), strips_.end(), [&](const Strip& s) { return s.high < low; });
  for (; strip != strips_.end() && strip->low <= high; ++strip) {
    const auto end = placed_.begin() + static_cast<std::ptrdiff_t>(strip->end);
    auto at = std::partition_point(placed_.begin() + static_cast<std::ptrdiff_t>(strip->begin), end,
                                   [&](const Placed& p) { return p.y < z.z(1) - reach_y; });
    for (; at != end && at->y <= z.z(1) + reach_y; ++at) try_one(*at);
  }
}

// The order of candidates does not change the assignment.
void Tracker::associate(const TrackSet& set, const sensors::ObservationList& list) {
  candidates_.clear();
  pairs_.clear();
  std::fill(near_track_.begin(), near_track_.end(), 0);
  place(set, list.observations.empty() ? kNoSensor : list.observations.front().sensor);
  for (std::size_t o = 0; o < list.observations.size(); ++o) {
    const sensors::Observation& z = list.observations[o];
    const auto try_one = [&](const Placed& placed) { try_pair(set, z, o, placed); };
    if (z.kind == sensors::ObservationKind::kPosition)
      near(z, gate_[dimension_of(z.kind)], try_one);
    else
      std::for_each(placed_.begin(), placed_.end(), try_one);
  }
  assignment_.solve(candidates_, list.observations.size(), set.tracks.size());
  if (config_.association == config::Association::kJpda)
    joint_.solve(pairs_, list.observations.size(), set.tracks.size());
  std::fill(observation_of_.begin(), observation_of_.end(), -1);
  const auto columns = assignment_.column_of();
  for (std::size_t o = 0; o < columns.size(); ++o)
    if (columns[o] >= 0) observation_of_[static_cast<std::size_t>(columns[o])] = static_cast<int>(o);
}

void Tracker::try_pair(const TrackSet& set, const sensors::Observation& z, std::size_t row, const Placed& placed) {
  const double gate = gate_[dimension_of(z.kind)];
  if (z.kind == sensors::ObservationKind::kPosition) {
    // A cheap bound comes first: outside the gate on one axis means outside the gate.
    const double dx = z.z(0) - placed.x, dy = z.z(1) - placed.y;
    if (dx * dx > gate * (placed.variance_x + z.r(0, 0)) || dy * dy > gate * (placed.variance_y + z.r(1, 1))) return;
  }
  const Track& track = set.tracks[placed.track];
  const int column = static_cast<int>(placed.track);
  if (config_.association == config::Association::kJpda) {
    offer(track, z, static_cast<int>(row), column);
    return;
  }
  const std::optional<double> distance_squared = estimator_->distance_squared(track.estimate, z);
  if (!distance_squared || *distance_squared > gate) return;
  if (track.confirmed) near_track_[row] = 1;
  // Never zero: a pair on the gate's edge still beats no pair.
  const double gain = gate - *distance_squared + 1e-9 + (track.confirmed ? kConfirmedBonus : 0.0);
  candidates_.push_back({static_cast<int>(row), column, gain});
}

// Offers a pair. The most probable joint event has the largest product of weights; it contains no pair that is
// less probable than both alone.
void Tracker::offer(const Track& track, const sensors::Observation& z, int row, int column) {
  const std::optional<estimators::Fit> fit = estimator_->fit(track.estimate, z);
  if (!fit || fit->distance_squared > gate_[dimension_of(z.kind)]) return;
  if (track.confirmed) near_track_[static_cast<std::size_t>(row)] = 1;
  const double weight = joint_weight(track.existence, likelihood_ratio(z, fit->density, config_), config_);
  pairs_.push_back({row, column, weight});
  if (weight > 1.0) candidates_.push_back({row, column, std::log(weight)});
}

// Updates the existence from the prediction, before the update of the estimate.
void Tracker::judge_existence(Track& track, const sensors::Observation* z) const {
  const std::optional<estimators::Fit> fit = z ? estimator_->fit(track.estimate, *z) : std::nullopt;
  track.existence = after_list(track.existence, fit ? likelihood_ratio(*z, fit->density, config_) : 0.0, config_);
}

// Updates by all observations in the track's gate, with their probabilities given that its object exists.
void Tracker::take_in_all(Track& track, std::size_t column, const sensors::ObservationList& list) {
  const double unseen = joint_.none_of_column(column) * exists_unseen(track.existence, config_);
  double exists = unseen;
  for (const association::JointAssociation::Shared& shared : joint_.of_column(column)) exists += shared.probability;
  if (!(exists > 0.0)) return;  // a long lost track without any observation
  explanations_.clear();
  explanations_.push_back({nullptr, unseen / exists});
  for (const association::JointAssociation::Shared& shared : joint_.of_column(column))
    explanations_.push_back({&list.observations[static_cast<std::size_t>(shared.row)], shared.probability / exists});
  if (explanations_.size() > 1) estimator_->update(track.estimate, explanations_);
  if (config_.birth == config::Birth::kExistence) track.existence = std::min(1.0, exists);
}

void Tracker::correct_outline(Track& track, const sensors::Observation& z) const {
  if (z.has_heading) {
    const estimators::Cartesian now = estimator_->cartesian(track.estimate);
    const double vx = now.x(2), vy = now.x(3);
    const double expected = track.heading.known        ? track.heading.value
                            : std::hypot(vx, vy) > 1.0 ? std::atan2(vy, vx)
                                                       : z.heading;
    const double measured = nearest_half_turn(z.heading, expected);
    correct_scalar(track.heading, motion::to_half_turn(measured - track.heading.value), measured, z.sigma_heading);
    track.heading.value = motion::to_half_turn(track.heading.value);
  }
  correct_extent(track, z);
}

// Corrects the extent. The span needs the aspect, so it comes last, after position, course and axis.
void Tracker::correct_extent(Track& track, const sensors::Observation& z) const {
  if (z.has_length) correct_length(track.extent, z.length, z.sigma_length);
  if (z.has_width) correct_width(track.extent, z.width, z.sigma_width);
  if (!z.has_span) return;
  const estimators::Cartesian now = estimator_->cartesian(track.estimate);
  const linear::Vector<2> from = place_of(config_.sensors, z.sensor);
  const double x = now.x(0) - from.x(), y = now.x(1) - from.y(), range = std::hypot(x, y);
  if (range <= 0.0) return;
  const Facing facing = facing_of(now, track.heading);
  const Eigen::Vector2d sight(x / range, y / range);
  const double range_variance = sight.dot(now.p.topLeftCorner<2, 2>() * sight);
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
    Track track;
    track.birth = track.newest = {list.id, static_cast<std::uint16_t>(o), list.measured};
    track.estimate = estimator_->initial(z);
    if (z.has_heading) track.heading = {z.heading, z.sigma_heading * z.sigma_heading, true};
    correct_extent(track, z);
    carry(track.unfiltered, z);
    track.hits = 1;
    track.lists = 1;
    if (config_.birth == config::Birth::kExistence) track.existence = config_.initial_existence;
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
                      : std::popcount(track.hits & window) >= config_.confirm_hits)) {
      track.confirmed = true;
      ++confirmed;
    }
  const double largest = config_.delete_position_sigma * config_.delete_position_sigma;
  std::erase_if(set.tracks, [&](const Track& track) {
    if (estimator_->position(track.estimate).p.diagonal().maxCoeff() > largest) return track.misses > 0;
    if (by_existence) return track.existence < config_.delete_existence;
    if (track.confirmed) return track.misses >= config_.delete_misses;
    // A tentative track ends when M hits are out of reach within its window.
    const int hits = std::popcount(track.hits & window);
    const int left = config_.confirm_window - std::min(track.lists, config_.confirm_window);
    return hits + left < config_.confirm_hits;
  });
}

}  // namespace ttf::fusion::tracks
