#include "fusion/tracks/parts/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fusion/motion/angles.h"
#include "fusion/tracks/body/facing.h"

namespace ttf::fusion::tracks::parts {
namespace {

constexpr double kPi = std::numbers::pi;
// Less than this is as good as nothing.
constexpr double kHardly = 1e-3;
// A heading beyond this standard deviation [rad] is unknown: the object then has the shape of its width.
constexpr double kNoHeading = 0.7;
// Lines of sight meet outlines up to this many standard deviations beside them. Wider ones meet no more.
constexpr double kBeside = 3.0, kWidest = 0.1;

double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

// The probability that a normal number with this mean and variance lies in low..high.
double between(double low, double high, double mean, double variance) {
  const double sigma = std::sqrt(variance);
  return below((high - mean) / sigma) - below((low - mean) / sigma);
}

// An object as a sensor at `from` sees it.
struct Seen {
  linear::Vector<2> centre, axis, size;  // from the sensor; along the length; length and width [m]
  linear::Matrix<2> p;                   // the position's covariance
  double range = 0.0, bearing = 0.0;     // the centre's
  double shown = 0.0, depth = 0.0;       // [m], across the line of sight, and the mean chord along it
};

linear::Vector<2> left_of(const linear::Vector<2>& axis) { return {-axis.y(), axis.x()}; }

// The centre lies behind a silhouette by half of the mean chord, L W / B under a silhouette of width B
// (fusion/tracks/body/anchor.h).
Seen seen_from(const Track& track, const estimators::Cartesian& estimate, const linear::Vector<2>& from) {
  const body::Facing facing = facing_of(estimate, track.heading);
  const double heading =
      track.heading.known ? body::nearest_half_turn(facing.heading, track.heading.value) : facing.heading;
  Seen seen;
  seen.axis << std::cos(heading), std::sin(heading);
  seen.size = track.extent.size;
  if (!(facing.sigma <= kNoHeading)) seen.size(0) = seen.size(1);
  seen.p = estimate.p.topLeftCorner<2, 2>();
  const linear::Vector<2> at = estimate.x.head<2>() - from, across = left_of(seen.axis);
  const double range = at.norm();
  const linear::Vector<2> sight = range > 0.0 ? linear::Vector<2>(at / range) : linear::Vector<2>::UnitX();
  seen.shown = seen.size(0) * std::abs(across.dot(sight)) + seen.size(1) * std::abs(seen.axis.dot(sight));
  seen.depth = seen.size.prod() / seen.shown;
  const body::Anchor& anchor = track.anchor;
  if (anchor.point == sensors::SeenPoint::kSilhouette)
    seen.centre = at + 0.5 * seen.depth * sight;
  else
    seen.centre = at - 0.5 * (anchor.along * seen.size(0) * seen.axis + anchor.across * seen.size(1) * across);
  seen.range = seen.centre.norm();
  seen.bearing = std::atan2(seen.centre.y(), seen.centre.x());
  return seen;
}

}  // namespace

Visibility::Visibility(const config::TrackerConfig& config, std::size_t max_tracks)
    : sensors_(config.sensors), by_existence_(config.birth == config::Birth::kExistence) {
  if (std::none_of(sensors_.begin(), sensors_.end(), [](const auto& sensor) { return sensor.field.has_value(); }))
    return;
  visible_.reserve(max_tracks);
  sights_.reserve(max_tracks);
  outlines_.reserve(2 * max_tracks);
  crossed_.reserve(2 * max_tracks);
}

void Visibility::judge(const std::vector<Track>& tracks, const estimators::Estimator& estimator, SensorId sensor,
                       std::span<const int> observation_of, const std::optional<sensors::Mounting>& vehicle) {
  sensor_ = known(sensors_, sensor);
  sees_all_ = sensor_ == nullptr || !sensor_->field;
  if (sees_all_) return;
  from_ = vehicle ? placed_on(*vehicle, sensor_->mounting) : sensor_->mounting;
  visible_.assign(tracks.size(), 1.0);
  sights_.clear();
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (!observation_of.empty() && observation_of[t] >= 0) continue;
    if (!tracks[t].confirmed && tracks[t].newest.measurement.sensor == sensor) continue;
    add_sight(tracks[t], t, estimator);
  }
  if (sights_.empty() || sensor_->field->shadow <= 0.0) return;
  outlines_.clear();
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (tracks[t].confirmed) add_outline(tracks[t], t, estimator);
  hide();
}

// Judges the field, and keeps the line of sight if the track may be in it.
void Visibility::add_sight(const Track& track, std::size_t index, const estimators::Estimator& estimator) {
  const sensors::Field& field = *sensor_->field;
  const Seen seen = seen_from(track, estimator.cartesian(track.estimate), from_.position);
  if (!(seen.range > 0.0)) return;
  const linear::Vector<2> along = seen.centre / seen.range, across = left_of(along);
  const double squared_range = seen.range * seen.range;
  const double variance = (across.dot(seen.p * across) + seen.shown * seen.shown / 12.0) / squared_range;
  double visible = between(field.min_range, field.max_range, seen.range - 0.5 * seen.depth,
                           along.dot(seen.p * along) + seen.depth * seen.depth / 12.0);
  if (!field.all_around())
    visible *= between(-field.half_angle, field.half_angle, motion::to_half_turn(seen.bearing - from_.yaw), variance);
  for (std::size_t i = 0; i < field.blind_sectors; ++i) {
    const auto [from, to] = field.blind[i];
    const double off = motion::to_half_turn(seen.bearing - from_.yaw - 0.5 * (from + to));
    visible *= 1.0 - between(0.5 * (from - to), 0.5 * (to - from), off, variance);
  }
  visible_[index] = visible;
  if (visible > kHardly) sights_.push_back({seen.bearing, seen.range, variance, index});
}

// An outline around the sensor hides nothing. One across the bearing of half a turn is met from both of its sides.
void Visibility::add_outline(const Track& track, std::size_t index, const estimators::Estimator& estimator) {
  const Seen seen = seen_from(track, estimator.cartesian(track.estimate), from_.position);
  if (!(seen.range > 0.0)) return;
  const linear::Vector<2> along = seen.centre / seen.range, across = left_of(along);
  Outline outline{.range = seen.range,
                  .exists = by_existence_ ? track.existence : 1.0,
                  .centre = seen.centre,
                  .axis = seen.axis,
                  .half = 0.5 * seen.size,
                  .track = index};
  outline.variance = across.dot(seen.p * across) / (seen.range * seen.range);
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      const linear::Vector<2> corner =
          seen.centre + a * outline.half(0) * seen.axis + b * outline.half(1) * left_of(seen.axis);
      const double off = std::atan2(across.dot(corner), along.dot(corner));
      if (std::abs(off) > 0.5 * kPi) return;
      outline.low = std::min(outline.low, off);
      outline.high = std::max(outline.high, off);
    }
  outline.low += seen.bearing;
  outline.high += seen.bearing;
  outlines_.push_back(outline);
  const double turn = outline.low < -0.5 * kPi ? 2.0 * kPi : outline.high > 0.5 * kPi ? -2.0 * kPi : 0.0;
  if (turn == 0.0) return;
  outline.low += turn;
  outline.high += turn;
  outlines_.push_back(outline);
}

void Visibility::hide() {
  double widest = 0.0;
  for (const Sight& sight : sights_) widest = std::max(widest, sight.variance);
  widest = std::min(widest, kWidest * kWidest);
  for (Outline& outline : outlines_) {
    const double beside = kBeside * std::sqrt(outline.variance + widest);
    outline.crossed_from = outline.low - beside;
    outline.crossed_to = outline.high + beside;
  }
  std::sort(sights_.begin(), sights_.end(), [](const Sight& a, const Sight& b) {
    return a.bearing != b.bearing ? a.bearing < b.bearing : a.track < b.track;
  });
  std::sort(outlines_.begin(), outlines_.end(), [&](const Outline& a, const Outline& b) {
    return a.crossed_from != b.crossed_from ? a.crossed_from < b.crossed_from : a.track < b.track;
  });
  const auto nearer = [](const Outline* a, const Outline* b) {
    return a->range != b->range ? a->range < b->range : a->track < b->track;
  };
  crossed_.clear();
  auto next = outlines_.begin();
  for (const Sight& sight : sights_) {
    std::erase_if(crossed_, [&](const Outline* outline) { return outline->crossed_to < sight.bearing; });
    for (; next != outlines_.end() && next->crossed_from <= sight.bearing; ++next)
      if (next->crossed_to >= sight.bearing)
        crossed_.insert(std::upper_bound(crossed_.begin(), crossed_.end(), &*next, nearer), &*next);
    double& visible = visible_[sight.track];
    for (const Outline* outline : crossed_) {
      if (visible <= kHardly) break;
      if (outline->track != sight.track) visible *= 1.0 - outline->exists * hidden(sight, *outline);
    }
  }
}

// The probability that the outline hides the end of the line of sight. A line that passes beside it is turned to its edge:
// there it may leave the outline before its end, or not.
double Visibility::hidden(const Sight& sight, const Outline& outline) const {
  const double edge = 0.05 * (outline.high - outline.low);
  const double bearing = std::clamp(sight.bearing, outline.low + edge, outline.high - edge);
  const linear::Vector<2> direction(std::cos(bearing), std::sin(bearing));
  double enter = 0.0, leave = sensors::Field::kUnbounded;
  for (int side = 0; side < 2; ++side) {
    const linear::Vector<2> axis = side == 0 ? outline.axis : left_of(outline.axis);
    const double towards = axis.dot(direction), middle = axis.dot(outline.centre), half = outline.half(side);
    if (towards == 0.0) continue;
    const double one = (middle - half) / towards, other = (middle + half) / towards;
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  if (!(leave < sight.range) || !(sight.range < enter * (1.0 + sensor_->field->shadow))) return 0.0;
  return between(outline.low, outline.high, sight.bearing, sight.variance + outline.variance);
}

}  // namespace ttf::fusion::tracks::parts
