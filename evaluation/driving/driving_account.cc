#include "evaluation/driving/driving_account.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "recording/scene/geometry.h"

namespace ttf::evaluation::driving {
namespace {

using recording::records::CommandVerdict;
using recording::records::WarningKind;

// A slower approach than walking pace is no collision course.
constexpr double kSlowestClosing_mps = 0.5;
constexpr double kBrakes = 1.0;  // [m/s^2]
constexpr double kStands_mps = 0.05;
constexpr Duration kOneMoment = Duration::microseconds(10);
constexpr Duration kJerkOver = Duration::milliseconds(40);
constexpr Duration kFollowed = Duration::milliseconds(2'000);  // beside the way
constexpr int kMostPeriods = 3;  // between two readings: after more the clocks' rates count, and no jitter

}  // namespace

void Spread::add(Duration duration) {
  const double seconds = duration.seconds();
  if (count_++ == 0) first_ = seconds;
  const double off = seconds - first_;
  sum_ += off;
  squares_ += off * off;
}
double Spread::mean() const { return count_ == 0 ? kNone : first_ + sum_ / static_cast<double>(count_); }
double Spread::deviation() const {
  if (count_ < 2) return kNone;
  const double n = static_cast<double>(count_);
  return std::sqrt(std::max(0.0, squares_ - sum_ * sum_ / n) / (n - 1.0));
}

void DetectionAccount::on(const recording::records::DetectionMade& detection) {
  if (detection.begin < from_) return;
  ++(detection.secondary ? findings_.secondary : findings_.primary);
  Camera& camera = cameras_[index_of(detection.id.sensor)];
  ++camera.detections;
  if (camera.last) camera.intervals.add(detection.begin - *camera.last);
  camera.last = detection.begin;
}

void DetectionAccount::on(const recording::records::SequencePlanned& planned) {
  const TrueTime at = planned.stamp.true_time;
  if (at < from_) return;
  if (frame_) findings_.frames.add(at - *frame_);
  frame_ = at;
}

std::optional<DetectionFindings> DetectionAccount::finish() const {
  if (findings_.primary + findings_.secondary == 0) return std::nullopt;
  DetectionFindings found = findings_;
  const auto most = std::ranges::max_element(cameras_, {}, &Camera::detections);
  found.camera = static_cast<SensorId>(most - cameras_.begin());
  found.intervals = most->intervals;
  return found;
}

InLane TrueLane::place_of(const recording::records::EgoTruth& ego) const {
  const sim::world::road::LinePlace place = road_.place_of(ego.x + config_.front_axle_m * std::cos(ego.heading),
                                                           ego.y + config_.front_axle_m * std::sin(ego.heading));
  const double direction = sim::world::road::Road::direction(config_.lane);
  const double along = road_.line_at(place.station).pose.heading + (direction < 0.0 ? std::numbers::pi : 0.0);
  return {direction * (place.offset - road_.middle(config_.lane)),
          std::remainder(ego.heading - along, 2.0 * std::numbers::pi)};
}

bool TrueLane::left_by(const InLane& place) const {
  return std::abs(place.offset) + 0.5 * config_.width_m > 0.5 * config_.road.lane_width;
}

bool LaneAccount::judge(const recording::records::EgoTruth& ego) {
  const InLane place = lane_.place_of(ego);
  const bool outside = lane_.left_by(place);
  ++moments_;
  if (outside) ++outside_;
  sums_.offset_rms_m += place.offset * place.offset;
  sums_.heading_rms_rad += place.heading * place.heading;
  sums_.largest_offset_m = std::max(sums_.largest_offset_m, std::abs(place.offset));
  sums_.largest_heading_rad = std::max(sums_.largest_heading_rad, std::abs(place.heading));
  return outside;
}

LaneFindings LaneAccount::findings() const {
  LaneFindings found = sums_;
  const double moments = static_cast<double>(std::max<std::uint64_t>(1, moments_));
  found.offset_rms_m = std::sqrt(found.offset_rms_m / moments);
  found.heading_rms_rad = std::sqrt(found.heading_rms_rad / moments);
  found.outside = static_cast<double>(outside_) / moments;
  return found;
}

DrivingAccount::DrivingAccount(const DrivingConfig& config, TrueTime from)
    : config_(config), from_(from), detections_(from), warnings_(from) {
  if (config.lane) lane_.emplace(*config.lane);
}

// Nodes report the truth at one instant of the cluster's time, each by its own clock, and in any order. The earliest one counts.
void DrivingAccount::on(const recording::records::EgoTruth& ego) {
  if (ego.at < from_) return;
  if (ego_ && ego.at - ego_->at < kOneMoment && ego_->at - ego.at < kOneMoment) {
    if (ego.at >= ego_->at) return;
    ahead_.reset();
    beside_ = {};
    if (fast_) fast_->speed.reset();
  } else {
    judge();
  }
  if (!findings_.collision) ego_ = ego;
}

void DrivingAccount::on(const recording::records::TruthState& object) {
  if (!ego_ || object.at != ego_->at) return;
  if (config_.blind_spot) note_beside(object);
  if (fast_ && fast_->object == object.object) fast_->speed = object.speed * std::cos(object.heading);
  const std::optional<double> gap =
      recording::scene::gap_ahead(object, config_.front_m, config_.width_m, recording::scene::way_curvature(*ego_));
  if (!gap || (ahead_ && ahead_->gap <= *gap)) return;
  const double along = std::cos(object.heading);
  ahead_ = Ahead{*gap, object.speed * along, object.acceleration * along, object.object};
}

void DrivingAccount::judge() {
  if (!ego_) return;
  ++findings_.moments;
  findings_.largest_deceleration = std::max(findings_.largest_deceleration, -ego_->acceleration);
  note_jerk();
  double remaining = DrivingFindings::kNone;
  if (ahead_) {
    const double gap = std::max(0.0, ahead_->gap), closing = ego_->vx - ahead_->speed;
    if (closing > kSlowestClosing_mps) remaining = gap / closing;
    findings_.smallest_gap_m = std::min(findings_.smallest_gap_m, gap);
    findings_.smallest_ttc_s = std::min(findings_.smallest_ttc_s, remaining);
    const double error = gap - config_.standstill_m - config_.time_gap_s * ego_->vx;
    gap_squares_ += error * error;
    ++behind_;
    if (config_.minimum_gap != nullptr && gap < config_.minimum_gap(ego_->vx)) ++below_;
    if (ahead_->gap <= 0.0) findings_.collision = {ego_->at, closing};
    note_braking(ahead_->acceleration);
  } else {
    note_braking(0.0);
  }
  note_slowing();
  note_hazards(remaining);
  before_ = ego_;
  ego_.reset();
  ahead_.reset();
  beside_ = {};
}

// The present moment is judged when the next one begins.
std::optional<TrueTime> DrivingAccount::collided_at() const {
  if (findings_.collision) return findings_.collision->at;
  return ego_ && ahead_ && ahead_->gap <= 0.0 ? std::optional(ego_->at) : std::nullopt;
}

void DrivingAccount::note_braking(double acceleration) {
  if (findings_.stopping_distance_m) return;
  if (braking_way_)
    *braking_way_ += std::hypot(ego_->x - before_->x, ego_->y - before_->y);
  else if (acceleration < -kBrakes)
    braking_way_ = 0.0;  // the way begins at this moment
  else
    return;
  if (ego_->vx < kStands_mps) findings_.stopping_distance_m = braking_way_;
}

// An object that is slow when it comes in front of the vehicle did not fall below the speed there. One that leaves the way for
// a moment, as the vehicle weaves, is still followed.
void DrivingAccount::note_slowing() {
  const bool another = fast_ && ahead_ && ahead_->object != fast_->object;
  if (another || (fast_ && ego_->at - fast_->ahead_at > kFollowed)) fast_.reset();
  if (!slow_at_ && fast_ && fast_->speed && *fast_->speed < config_.reaction_speed_mps) {
    slow_at_ = ego_->at;
    if (stated_slow_) note_reaction(*stated_slow_);
  }
  if (ahead_ && ahead_->speed >= config_.reaction_speed_mps) fast_ = Leader{ahead_->object, ego_->at, std::nullopt};
  if (fast_) fast_->speed.reset();
  stated_slow_.reset();
}

void DrivingAccount::note_reaction(TrueTime image) {
  if (!findings_.reaction && !findings_.collision && image >= *slow_at_) findings_.reaction = image - *slow_at_;
}

void DrivingAccount::on(const recording::records::ImageWritten& image) {
  if (findings_.reaction || findings_.collision) return;
  // The image's object in the way is found as the true one is.
  std::optional<double> nearest, speed;
  for (const recording::records::ImageObject& object : image.objects) {
    if (!has(object.status, recording::records::ImageStatus::kConfirmed)) continue;
    recording::records::TruthState believed;
    believed.x = object.x;
    believed.y = object.y;
    believed.heading = object.heading;
    believed.length = object.length;
    believed.width = object.width;
    const std::optional<double> gap = recording::scene::gap_ahead(
        believed, config_.front_m, config_.width_m, before_ ? recording::scene::way_curvature(*before_) : 0.0);
    if (!gap || (nearest && *nearest <= *gap)) continue;
    nearest = gap;
    speed = object.speed * std::cos(object.heading);
  }
  if (!speed || *speed >= config_.reaction_speed_mps) return;
  if (slow_at_)
    note_reaction(image.stamp.true_time);
  else if (!stated_slow_ && ego_ && image.stamp.true_time >= ego_->at)
    stated_slow_ = image.stamp.true_time;  // whether it is true is known at the next moment
}

// At a standstill the acceleration ends with the motion, whatever the brakes do: no controller decides about it.
void DrivingAccount::note_jerk() {
  if (ego_->vx < kStands_mps) return jerk_from_.reset();
  if (!jerk_from_) jerk_from_ = ego_;
  const Duration over = ego_->at - jerk_from_->at;
  if (over < kJerkOver) return;
  const double jerk = (ego_->acceleration - jerk_from_->acceleration) / over.seconds();
  findings_.largest_jerk = std::max(findings_.largest_jerk, std::abs(jerk));
  jerk_squares_ += jerk * jerk;
  ++jerks_;
  jerk_from_ = ego_;
}

void DrivingAccount::note_hazards(double time_to_collision) {
  for (std::size_t service = 0; service < config_.hazard_time_s.size(); ++service)
    warnings_.judge(static_cast<WarningKind>(service), ego_->at, time_to_collision < config_.hazard_time_s[service]);
  if (lane_) warnings_.judge(WarningKind::kLaneDeparture, ego_->at, lane_->judge(*ego_));
  warnings_.judge(WarningKind::kBlindSpotLeft, ego_->at, beside_[0]);
  warnings_.judge(WarningKind::kBlindSpotRight, ego_->at, beside_[1]);
}

void DrivingAccount::note_beside(const recording::records::TruthState& object) {
  const auto outline = recording::scene::rectangle({object.x, object.y, object.heading}, object.length, object.width);
  const BlindSpotZone& zone = *config_.blind_spot;
  const double length = zone.ahead_m + zone.behind_m, width = zone.furthest_m - zone.nearest_m;
  const double middle = 0.5 * (config_.width_m + zone.nearest_m + zone.furthest_m);
  for (const std::size_t right : {0, 1})
    beside_[right] =
        beside_[right] ||
        recording::scene::overlap(
            outline, recording::scene::rectangle(
                         {0.5 * (zone.ahead_m - zone.behind_m), right == 0 ? middle : -middle, 0.0}, length, width));
}

void DrivingAccount::on(const recording::records::CommandIssued& command) {
  if (command.stamp.true_time >= from_) ++findings_.issued;
  warnings_.note_alive(command.stamp.node, command.stamp.true_time);
}

void DrivingAccount::on(const recording::records::TaskRun& run) {
  warnings_.note_alive(run.start.node, run.start.true_time);
}

void DrivingAccount::on(const recording::records::PowerChanged& power) {
  warnings_.note_power(power.stamp.node, power.stamp.true_time);
}

void DrivingAccount::on(const recording::records::CommandTaken& taken) {
  if (taken.stamp.true_time < from_) return;
  note_jitter(taken);
  switch (taken.verdict) {
    case CommandVerdict::kApplied: ++findings_.applied; break;
    case CommandVerdict::kNoneNew: ++findings_.none_new; break;
    case CommandVerdict::kInvalid: ++findings_.invalid; break;
    case CommandVerdict::kLate: ++findings_.late; break;
    case CommandVerdict::kNothingAsked: ++findings_.nothing_asked; break;
    case CommandVerdict::kWeaker: ++findings_.weaker; break;
  }
}

// A reading has a record for each port. A refused command may be one that was read without global time. A reading without a
// new command may be, too: then its global time is the local one.
void DrivingAccount::note_jitter(const recording::records::CommandTaken& taken) {
  if (read_ && read_->true_time == taken.stamp.true_time) return;
  const bool is_local = taken.stamp.global.ns == taken.stamp.local.ns;
  const bool in_global_time = taken.verdict != CommandVerdict::kLate && !(has_own_time_ && is_local);
  has_own_time_ = has_own_time_ || !is_local;
  if (read_ && in_global_time) {
    const Duration by_cluster = taken.stamp.global - read_->global;
    const Duration apart = (taken.stamp.true_time - read_->true_time) - by_cluster;
    if (!config_.reads_every || by_cluster <= *config_.reads_every * kMostPeriods)
      findings_.reading_jitter.add(Duration{std::abs(apart.ns)});
  }
  read_ = in_global_time ? std::optional(taken.stamp) : std::nullopt;
}

void DrivingAccount::on(const recording::records::Warning& warning) {
  if (!findings_.collision) warnings_.warn(warning);
}

DrivingFindings DrivingAccount::finish() {
  judge();
  if (behind_ > 0) {
    findings_.gap_error_rms_m = std::sqrt(gap_squares_ / static_cast<double>(behind_));
    findings_.below_minimum = static_cast<double>(below_) / static_cast<double>(behind_);
  }
  if (jerks_ > 0) findings_.jerk_rms = std::sqrt(jerk_squares_ / static_cast<double>(jerks_));
  for (std::size_t service = 0; service < findings_.warnings.size(); ++service)
    findings_.warnings[service] =
        warnings_.finish(static_cast<WarningKind>(service), before_ ? before_->at : TrueTime{});
  if (lane_) findings_.lane = lane_->findings();
  findings_.warns_ahead = config_.warns_ahead;
  findings_.watches_blind_spot = config_.blind_spot.has_value();
  findings_.detections = detections_.finish();
  return findings_;
}

}  // namespace ttf::evaluation::driving
