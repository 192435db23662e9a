#include "evaluation/driving/driving_account.h"

#include <algorithm>
#include <cmath>

#include "recording/scene/geometry.h"

namespace ttf::evaluation::driving {
namespace {

// A slower approach than walking pace is no collision course.
constexpr double kSlowestClosing_mps = 0.5;
constexpr double kBrakes = 1.0;  // [m/s^2]
constexpr double kStands_mps = 0.05;
constexpr Duration kJerkOver = Duration::milliseconds(40);

}  // namespace

void DrivingAccount::on(const recording::records::EgoTruth& ego) {
  if (ego_ && ego_->at == ego.at) return;  // another node tells the same
  judge();
  if (ego.at >= from_ && !findings_.collision) ego_ = ego;
}

void DrivingAccount::on(const recording::records::TruthState& object) {
  if (!ego_ || object.at != ego_->at) return;
  const std::optional<double> gap = recording::scene::gap_ahead(object, config_.front_m, config_.width_m);
  if (!gap || (ahead_ && ahead_->gap <= *gap)) return;
  const double along = std::cos(object.heading);
  ahead_ = Ahead{*gap, object.speed * along, object.acceleration * along};
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
    note_slowing(ahead_->speed);
  } else {
    note_braking(0.0);
  }
  note_hazards(remaining);
  before_ = ego_;
  ego_.reset();
  ahead_.reset();
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

void DrivingAccount::note_slowing(double speed_ahead) {
  if (!slow_at_ && was_fast_ && speed_ahead < config_.reaction_speed_mps) slow_at_ = ego_->at;
  was_fast_ = speed_ahead >= config_.reaction_speed_mps;
}

void DrivingAccount::on(const recording::records::ImageWritten& image) {
  if (!slow_at_ || findings_.reaction || findings_.collision || image.stamp.true_time < *slow_at_) return;
  // The image's object in the way is found as the true one is.
  std::optional<double> nearest, speed;
  for (const recording::records::ImageObject& object : image.objects) {
    if ((object.status & recording::records::kImageConfirmed) == 0) continue;
    recording::records::TruthState believed;
    believed.x = object.x;
    believed.y = object.y;
    believed.heading = object.heading;
    believed.length = object.length;
    believed.width = object.width;
    const std::optional<double> gap = recording::scene::gap_ahead(believed, config_.front_m, config_.width_m);
    if (!gap || (nearest && *nearest <= *gap)) continue;
    nearest = gap;
    speed = object.speed * std::cos(object.heading);
  }
  if (speed && *speed < config_.reaction_speed_mps) findings_.reaction = image.stamp.true_time - *slow_at_;
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
  for (std::size_t service = 0; service < hazards_.size(); ++service) {
    const bool now = time_to_collision < config_.hazard_time_s[service];
    if (now && !hazard_[service]) hazards_[service].push_back({ego_->at, ego_->at});
    if (now) hazards_[service].back().to = ego_->at;
    hazard_[service] = now;
  }
}

void DrivingAccount::on(const recording::records::CommandIssued& command) {
  const TrueTime at = command.stamp.true_time;
  if (at >= from_) ++findings_.issued;
  for (std::size_t service = 0; service < warns_.size(); ++service) {
    if (!warns_[service] || command.stamp.node != warner_[service]) continue;
    note_silence(service, at);
    heard_[service] = at;
  }
}

void DrivingAccount::note_silence(std::size_t service, TrueTime until) {
  if (!warns_[service] || until - heard_[service] <= kSilent) return;
  warned_[service].back().to = heard_[service];
  warns_[service] = false;
}

void DrivingAccount::on(const recording::records::CommandTaken& taken) {
  if (taken.stamp.true_time < from_) return;
  switch (taken.verdict) {
    case recording::records::kApplied: ++findings_.applied; break;
    case recording::records::kNoNewCommand: ++findings_.none_new; break;
    case recording::records::kInvalidCommand: ++findings_.invalid; break;
    case recording::records::kLateCommand: ++findings_.late; break;
    case recording::records::kNothingAsked: ++findings_.nothing_asked; break;
    case recording::records::kWeakerCommand: ++findings_.weaker; break;
  }
}

void DrivingAccount::on(const recording::records::Warning& warning) {
  const TrueTime at = warning.stamp.true_time;
  if (warning.service >= warned_.size() || findings_.collision) return;
  note_silence(warning.service, at);
  warner_[warning.service] = warning.stamp.node;
  heard_[warning.service] = at;
  std::vector<Span>& all = warned_[warning.service];
  if (warning.on && !warns_[warning.service]) all.push_back({at, kNever<TrueTime>});
  if (!warning.on && warns_[warning.service]) all.back().to = at;
  warns_[warning.service] = warning.on;
}

WarningFindings DrivingAccount::judged(std::size_t service) const {
  // A time to collision that leaves the hazard for a moment does not end it.
  std::vector<Span> hazards;
  for (const Span& one : hazards_[service])
    if (!hazards.empty() && one.from - hazards.back().to < kTolerance)
      hazards.back().to = one.to;
    else
      hazards.push_back(one);
  WarningFindings found;
  const auto meet = [](const Span& warning, const Span& hazard) {
    return warning.from <= hazard.to + kTolerance && warning.to >= hazard.from - kTolerance;
  };
  for (const Span& warning : warned_[service]) {
    if (warning.to < from_) continue;
    ++found.given;
    const bool right =
        std::any_of(hazards.begin(), hazards.end(), [&](const Span& hazard) { return meet(warning, hazard); });
    ++(right ? found.right : found.wrong);
  }
  for (const Span& hazard : hazards) {
    if (hazard.to - hazard.from < kNoticed) continue;
    ++found.hazards;
    const auto first = std::find_if(warned_[service].begin(), warned_[service].end(),
                                    [&](const Span& warning) { return meet(warning, hazard); });
    if (first == warned_[service].end()) {
      ++found.missed;
    } else if (first->from > hazard.from) {
      ++found.late;
      found.lateness_sum += first->from - hazard.from;
      found.latest = std::max(found.latest, first->from - hazard.from);
    }
  }
  return found;
}

DrivingFindings DrivingAccount::finish() {
  judge();
  if (behind_ > 0) {
    findings_.gap_error_rms_m = std::sqrt(gap_squares_ / static_cast<double>(behind_));
    findings_.below_minimum = static_cast<double>(below_) / static_cast<double>(behind_);
  }
  if (jerks_ > 0) findings_.jerk_rms = std::sqrt(jerk_squares_ / static_cast<double>(jerks_));
  for (std::size_t service = 0; service < hazards_.size(); ++service) {
    if (before_) note_silence(service, before_->at);
    findings_.warnings[service] = judged(service);
  }
  findings_.detections = detections_.finish();
  return findings_;
}

}  // namespace ttf::evaluation::driving
