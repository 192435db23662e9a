#include "experiments/sweep/expected_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "evaluation/accuracy/plane.h"
#include "sim/drives/drive.h"

namespace ttf::experiments::sweep {
namespace {

using evaluation::accuracy::Face;
using sensors::Shows;
using sensors::kinds::Sensors;
using sensors::kinds::SensorsOfKind;

constexpr double kQuarter = 0.5 * std::numbers::pi;
constexpr double kWorldStep_s = 0.01;  // the world draws once per step (sim/world/world.h)
constexpr std::size_t kMostTruths = 128, kMostSeen = 128, kMostImages = 8;
// A prior counts as the nominal size if it is nearer to it than this [m].
constexpr double kKnown_m = 0.02;
// The share of a measured side's variance that repeats (fusion/tracks/body/extent.cc).
constexpr double kRepeating = 0.8;
// A picture of an object of a less certain heading shows no width [rad].
constexpr double kWorstAspect = 0.3;

// The tracker's density along the vehicle's x axis, and across it.
Eigen::Matrix2d assumed_density(const fusion::config::TrackerConfig& tracker) {
  return Eigen::Vector2d(tracker.process_noise, tracker.noise_across()).asDiagonal();
}

// Converts the world's noise to white noise: the acceleration along the heading, and across it the turn rate's
// effect at this speed.
PointMotion motion_of(const sim::drives::Scenario& scenario) {
  const sim::world::ObjectConfig& object = scenario.world.objects.front();
  PointMotion motion = PointMotion::known(scenario.tracker.process_noise, scenario.tracker.initial_velocity_sigma);
  motion.assumed = assumed_density(scenario.tracker);
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  const double along = scenario.world.acceleration_noise, across = scenario.world.yaw_rate_noise * object.speed;
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const Eigen::Vector2d density(along * along * kWorldStep_s, across * across * kWorldStep_s);
  motion.actual = turn * density.asDiagonal() * turn.transpose();
  if (scenario.world.speed_memory > Duration{}) {
    // The noise along the heading is forgotten, that of the turn rate is not.
    const Eigen::Vector2d kept(0.0, density.y()), forgotten(density.x(), 0.0);
    motion.actual = turn * kept.asDiagonal() * turn.transpose();
    motion.forgotten = turn * forgotten.asDiagonal() * turn.transpose();
    motion.memory = scenario.world.speed_memory.seconds();
  }
  const Eigen::Vector2d velocity(object.speed * c - scenario.world.own_speed, object.speed * s);
  motion.actual_velocity = velocity * velocity.transpose();
  return motion;
}

// The shortest sides of the object, whatever is drawn.
sim::world::Size least_of(const sim::world::ObjectConfig& object) {
  switch (object.size.draw) {
    case sim::world::SizeDraw::kNormal: return {object.size.normal.shortest, object.size.normal.narrowest};
    case sim::world::SizeDraw::kUniform: return {object.size.uniform.shortest, object.size.uniform.narrowest};
    case sim::world::SizeDraw::kNominal: break;
  }
  return {object.length, object.width};
}

// Whether the object shows one face alone to a sensor there.
bool shows_one_face(const sim::world::ObjectConfig& object, const sensors::Placement& from) {
  const sim::world::Size least = least_of(object);
  const double c = std::cos(object.heading), s = std::sin(object.heading), x = from.x - object.x, y = from.y - object.y;
  return (std::abs(c * x + s * y) < 0.5 * least.length) != (std::abs(c * y - s * x) < 0.5 * least.width);
}

bool size_is_known(const fusion::config::Sizes& prior, const sim::world::ObjectConfig& object) {
  return object.size.draw == sim::world::SizeDraw::kNominal && std::abs(prior.length - object.length) < kKnown_m &&
         std::abs(prior.width - object.width) < kKnown_m && prior.length_sigma <= kKnown_m &&
         prior.width_sigma <= kKnown_m;
}

bool shows_one_face(const sim::drives::Scenario& scenario) {
  const sim::world::ObjectConfig& object = scenario.world.objects.front();
  bool alone = true;
  Sensors::each(scenario.sensors, [&]<class Kind>(const SensorsOfKind<Kind>& kind) {
    if (Kind::kShows == Shows::kNothing) return;
    alone = alone && shows_one_face(object, kind.usual.model.device.placement);
    for (const auto& entry : kind.own) alone = alone && shows_one_face(object, entry.model.device.placement);
  });
  return alone;
}

Face face_in_view(const sim::world::ObjectConfig& object) {
  return evaluation::accuracy::visible_face({object.x, object.y, object.heading, object.length, object.width});
}

Eigen::Vector2d direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
// The heading's angle to the way from the face to the centre.
double inward(Face face) {
  switch (face) {
    case Face::kRear: return 0.0;
    case Face::kFront: return std::numbers::pi;
    case Face::kRight: return kQuarter;
    case Face::kLeft: break;
  }
  return -kQuarter;
}

// Returns the span [rad] times `range` of an outline whose face of this side, at `range`, is turned by `angle`.
double shown_at(double angle, double range, double side, double behind) {
  const double c = std::cos(angle), s = std::sin(angle), centre = range + 0.5 * behind;
  double low = 0.0, high = 0.0;
  for (const double u : {-0.5, 0.5})
    for (const double v : {-0.5, 0.5}) {
      const double azimuth = std::atan2(s * u * behind + c * v * side, centre + c * u * behind - s * v * side);
      low = std::min(low, azimuth);
      high = std::max(high, azimuth);
    }
  return (high - low) * range;
}

// Zero on the outline, and the distance to it from within and without.
double distance_to_outline(const recording::records::TruthState& box, double x, double y) {
  const double c = std::cos(box.heading), s = std::sin(box.heading), dx = x - box.x, dy = y - box.y;
  const double along = std::abs(c * dx + s * dy) - 0.5 * box.length,
               across = std::abs(c * dy - s * dx) - 0.5 * box.width;
  return along < 0.0 && across < 0.0 ? -std::max(along, across)
                                     : std::hypot(std::max(0.0, along), std::max(0.0, across));
}

}  // namespace

bool ExpectedError::is_defined(const sim::drives::Scenario& scenario) {
  if (scenario.world.objects.size() != 1 || scenario.tracker.motion != fusion::config::MotionModel::kConstantVelocity ||
      scenario.tracker.extent_noise > 0.0 || !scenario.tracker.classes.empty() || scenario.world.ego ||
      scenario.world.objects.front().on)
    return false;
  return size_is_known(scenario.tracker.sizes, scenario.world.objects.front()) || shows_one_face(scenario);
}

ExpectedError::ExpectedError(const sim::drives::Scenario& scenario, const schedules::model::Cluster& cluster)
    : sensors_(scenario.sensors), tracker_(scenario.tracker), of_cluster_(cluster.sensors),
      drawn_(moments_of(scenario.world.objects.front().size,
                        {scenario.world.objects.front().length, scenario.world.objects.front().width})),
      prior_(moments_of(scenario.tracker.sizes)), face_(face_in_view(scenario.world.objects.front())),
      alone_(shows_one_face(scenario)), from_(sim::drives::evaluation_start(scenario)), motion_(motion_of(scenario)),
      recursion_(motion_), size_(drawn_, prior_), heading_(scenario.tracker) {}

double ExpectedError::mean_of(double sum) const {
  return uses_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(uses_);
}

Eigen::Index ExpectedError::hidden() const { return face_ == Face::kRear || face_ == Face::kFront ? 0 : 1; }

sensors::Shows ExpectedError::shows(const Seen& seen) const {
  return Sensors::of_kind(sensors_, of_cluster_.at(index_of(seen.id.sensor)).kind,
                          []<class Kind>(const SensorsOfKind<Kind>&) { return Kind::kShows; });
}

std::optional<SizeLook> ExpectedError::size_seen(const Seen& seen) const {
  const schedules::model::Sensor& sensor = of_cluster_.at(index_of(seen.id.sensor));
  return Sensors::of_kind(sensors_, sensor.kind,
                          [&]<class Kind>(const SensorsOfKind<Kind>& kind) -> std::optional<SizeLook> {
                            if constexpr (Kind::kShows == Shows::kSilhouette) {
                              const typename Kind::Preprocessing& camera = kind.preprocessing_of(sensor.name);
                              return silhouette_seen(seen, kind.of(sensor.name).model.device.placement, camera.focal_px,
                                                     camera.width_sigma_px);
                            }
                            return Kind::kShows == Shows::kFace ? std::optional(face_seen(seen)) : std::nullopt;
                          });
}

// Both ends of a face err alike. So the variance of their distance is four times that of their middle.
SizeLook ExpectedError::face_seen(const Seen& seen) const {
  const Eigen::Vector2d across = direction(seen.heading + inward(face_) + kQuarter);
  const double variance = 4.0 * across.dot(seen.noise * across);
  return {index_of(seen.id.sensor), Eigen::Vector2d::Unit(shown()), (1.0 - kRepeating) * variance,
          kRepeating * variance};
}

// The width in the picture depends on the estimated range and heading, whose errors repeat. At the edge of the face the
// next one appears, so that the larger difference counts.
std::optional<SizeLook> ExpectedError::silhouette_seen(const Seen& seen, const sensors::Placement& place,
                                                       double focal_px, double width_sigma_px) const {
  const Eigen::Vector2d way = seen.at - Eigen::Vector2d(place.x, place.y);
  const double range = way.norm(), bearing = std::atan2(way.y(), way.x()) - place.heading;
  const double sigma = width_sigma_px * std::cos(bearing) / focal_px * range;
  const Facing facing = this->facing(recursion_.newest(), seen.heading, seen.speed);
  if (facing.variance > kWorstAspect * kWorstAspect) return std::nullopt;
  const Eigen::Matrix2d position = recursion_.believed(recursion_.newest()).topLeftCorner<2, 2>();
  const double range_variance = way.dot(position * way) / (range * range) + 0.25 * size_.believed()(hidden(), hidden());
  const double shown_side = prior_.mean(shown()), hidden_side = prior_.mean(hidden());
  const double by_range = shown_side / range * std::sqrt(range_variance);
  const double by_aspect = shown_at(std::sqrt(facing.variance), range, shown_side, hidden_side) - shown_side;
  return SizeLook{index_of(seen.id.sensor), Eigen::Vector2d::Unit(shown()), sigma * sigma,
                  by_range * by_range + by_aspect * by_aspect};
}

// A line through returns along a face of width w: its angle has 12 / w^2 of the variance of its middle.
void ExpectedError::take_axis(const Seen& seen) {
  if (shows(seen) != Shows::kFace) return;
  const Eigen::Vector2d normal = direction(seen.heading + inward(face_));
  const double width = prior_.mean(shown());
  heading_.see(seen.measured, 12.0 * normal.dot(seen.noise * normal) / (width * width), seen.speed);
}

// The course is that of the centre, which the turn rate moves against the face. It has the weight 1 - w, and the measured
// axis w, each by its certainty.
ExpectedError::Facing ExpectedError::facing(GlobalTime at, double heading, double speed) const {
  constexpr double kMoving = std::numbers::pi * std::numbers::pi / 12.0;  // [rad^2]
  constexpr double kStanding = 1e-3;                                      // [m/s]
  const HeadingRecursion::Moments axis = heading_.at(at, speed);
  const Eigen::Vector2d across = direction(heading + kQuarter);
  const double lever = half_hidden() * across.dot(direction(heading + inward(face_) + kQuarter));
  const double by_velocity = 1.0 / std::copysign(std::max(kStanding, std::abs(speed)), speed),
               by_rate = by_velocity * lever;
  const double velocity = across.dot(recursion_.believed(at).bottomRightCorner<2, 2>() * across);
  const double course = by_velocity * by_velocity * velocity + by_rate * by_rate * axis.believed(1, 1);
  const bool moves = course < kMoving;
  if (!moves && !heading_.known()) return {};
  const double w = !moves ? 1.0 : heading_.known() ? course / (course + axis.believed(0, 0)) : 0.0;
  const Eigen::Vector2d by_axis(w, (1.0 - w) * by_rate);
  return {heading_.known() ? w * axis.believed(0, 0) : course, (1.0 - w) * by_velocity,
          by_axis.dot(axis.actual * by_axis)};
}

// 2 l q' E[e_p e_h] + l^2 E[e_h^2]: l is half of the hidden side, q points across it, and e_h is the heading's error. An
// unknown heading adds nothing.
double ExpectedError::swing(const Eigen::Matrix4d& error, GlobalTime at) const {
  if (!alone_) return 0.0;
  const recording::records::TruthState& truth = truth_.back();
  const Facing facing = this->facing(at, truth.heading, truth.speed);
  const Eigen::Vector2d by_velocity = direction(truth.heading + kQuarter) * facing.by_velocity,
                        q = direction(truth.heading + inward(face_) + kQuarter);
  const double l = half_hidden();
  return 2.0 * l * q.dot(error.topRightCorner<2, 2>() * by_velocity) +
         l * l * (by_velocity.dot(error.bottomRightCorner<2, 2>() * by_velocity) + facing.by_axis);
}

void ExpectedError::on(const recording::records::TruthState& truth) {
  truth_.push_back(truth);
  if (truth_.size() > kMostTruths) truth_.pop_front();
}

// Truth is recorded when sensors measure, by their own clocks: take the nearest one.
void ExpectedError::on(const recording::records::ObservationSeen& observation) {
  const TrueTime measured = recording::records::true_time_of(observation.stamp, observation.measured);
  const auto off = [&](const recording::records::TruthState& truth) { return std::abs((truth.at - measured).ns); };
  const auto truth =
      std::min_element(truth_.begin(), truth_.end(), [&](const auto& a, const auto& b) { return off(a) < off(b); });
  if (truth == truth_.end()) return;
  const double distance = distance_to_outline(*truth, observation.x, observation.y);
  if (distance > evaluation::accuracy::kGate_m) return;
  Seen seen{observation.id, observation.measured, distance, {observation.x, observation.y}, {},
            truth->heading, truth->speed};
  seen.noise << observation.sxx, observation.sxy, observation.sxy, observation.syy;
  const auto known = std::find_if(seen_.begin(), seen_.end(),
                                  [&](const Seen& one) { return one.id == seen.id && one.measured == seen.measured; });
  if (known == seen_.end()) {
    seen_.push_back(seen);
    if (seen_.size() > kMostSeen) seen_.pop_front();
  } else if (distance < known->distance) {
    *known = seen;
  }
}

void ExpectedError::on(const recording::records::ListFused& list) {
  // A restarted fusion node has forgotten everything, and may count time anew.
  if (list.stamp.global < fusing_) {
    recursion_ = ErrorRecursion(motion_);
    size_ = SizeRecursion(drawn_, prior_);
    heading_ = HeadingRecursion(tracker_);
    images_.clear();
  }
  fusing_ = list.stamp.global;
  if (list.disposition != recording::records::Disposition::kFused &&
      list.disposition != recording::records::Disposition::kFusedLate)
    return;
  const auto seen = std::find_if(seen_.begin(), seen_.end(),
                                 [&](const Seen& one) { return one.id == list.id && one.measured == list.measured; });
  if (seen == seen_.end()) return;
  recursion_.fuse({seen->measured, seen->noise});
  take_axis(*seen);
  if (const std::optional<SizeLook> look = size_seen(*seen)) size_.see(*look);
  seen_.erase(seen);
}

void ExpectedError::on(const recording::records::ImageWritten& image) {
  if (recursion_.empty() || image.objects.empty() || image.valid_at < image.newest_measurement) return;
  const Eigen::Matrix4d error = recursion_.at(image.valid_at);
  const double face = error.topLeftCorner<2, 2>().trace();
  images_.push_back(
      {image.sequence, face, face + 0.25 * size_.error()(hidden(), hidden()) + swing(error, image.valid_at)});
  if (images_.size() > kMostImages) images_.pop_front();
}

void ExpectedError::on(const recording::records::FeatureUsed& used) {
  if (used.stamp.true_time < from_ || !used.fresh || used.stale) return;
  const auto image = std::find_if(images_.rbegin(), images_.rend(),
                                  [&](const Image& one) { return one.sequence == used.image_sequence; });
  if (image == images_.rend()) return;
  face_sum_ += image->face;
  position_sum_ += image->position;
  ++uses_;
}

}  // namespace ttf::experiments::sweep
