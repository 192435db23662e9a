#include "nodes/driving/adaptive_cruise_control.h"

#include <algorithm>
#include <limits>

namespace ttf::nodes::driving {
namespace {

// A vehicle that stands waits for a clear demand. Noise alone would let it creep, since it never rolls back.
constexpr double kStands_mps = 0.3;
constexpr double kSetsOff = 0.3, kHolds = 1.0;  // [m/s^2]

}  // namespace

CruiseConfig load_cruise(YamlMap& yaml) {
  CruiseConfig c;
  c.set_speed_mps = yaml.number_or("set_speed", c.set_speed_mps, {0.0, 100.0}, "m/s");
  c.law.time_gap_s = yaml.number_or("time_gap", c.law.time_gap_s, {0.1, 10.0}, "s");
  c.law.standstill_m = yaml.number_or("standstill", c.law.standstill_m, {0.0, 50.0}, "m");
  c.law.gap_gain = yaml.number_or("gap_gain", c.law.gap_gain, {0.0, 10.0}, "1/s^2");
  c.law.speed_gain = yaml.number_or("speed_gain", c.law.speed_gain, {0.0, 10.0}, "1/s");
  c.law.set_gain = yaml.number_or("set_gain", c.law.set_gain, {0.01, 10.0}, "1/s");
  load_path(yaml, c.path);
  return c;
}

AdaptiveCruiseControl::AdaptiveCruiseControl(const schedules::model::Cluster& cluster,
                                             const schedules::model::Task& task, const CruiseConfig& config)
    : config_(config), way_(cluster, task, config.path), out_(cluster, task) {}

void AdaptiveCruiseControl::run(host::StepContext& context) {
  const std::optional<View> view = way_.look(context);
  const LocalTime now = context.stamp.local;
  if (issued_ && now - *issued_ > config_.memory) {
    issued_.reset();
    before_ = std::min(before_, 0.0);
  }
  // Executions may not have happened for any time, as without global time.
  const Duration since = std::min(now - issued_.value_or(last_), config_.memory);
  const double dt = context.activation > 0 ? since.seconds() : 0.0;
  last_ = now;
  recording::records::CommandIssued record;
  record.gap = std::numeric_limits<double>::infinity();
  record.track = kNoTrack;
  if (!view) return out_.issue(context, {}, record);
  issued_ = now;
  std::optional<control::Ahead> ahead;
  if (view->ahead) ahead = control::Ahead{view->ahead->clearance, view->ahead->speed};
  const double free = control::time_gap_acceleration(config_.law, view->own_speed, config_.set_speed_mps, std::nullopt);
  const double wanted = control::time_gap_acceleration(config_.law, view->own_speed, config_.set_speed_mps, ahead);
  const bool waits = view->own_speed < kStands_mps && wanted < kSetsOff;
  const double asked = waits ? std::min(wanted, -kHolds) : wanted;
  before_ = control::limited(control::at_speed(config_.limits, view->own_speed), asked, before_, dt);
  record.own_speed = view->own_speed;
  record.reason =
      wanted < free ? recording::records::CommandReason::kGap : recording::records::CommandReason::kSetSpeed;
  if (view->ahead) {
    record.track = view->ahead->track;
    record.gap = view->ahead->clearance;
    record.speed_ahead = view->ahead->speed;
  }
  out_.issue(context, {true, before_, 0.0}, record);
}

}  // namespace ttf::nodes::driving
