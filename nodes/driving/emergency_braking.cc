#include "nodes/driving/emergency_braking.h"

#include <fmt/format.h>

#include <limits>

#include "nodes/control/time_to_collision.h"

namespace ttf::nodes::driving {
namespace {

using recording::records::WarningKind;

constexpr double kNone = std::numeric_limits<double>::infinity();
// A slower approach than walking pace is no collision course: the sign of a speed near zero is noise.
constexpr double kSlowestClosing_mps = 0.5;
constexpr double kStopped_mps = 0.2;

double time_to(const ObjectAhead& ahead, double own_speed) {
  const double closing = own_speed - ahead.speed;
  return closing > kSlowestClosing_mps ? control::time_to_collision(ahead.clearance, closing) : kNone;
}

}  // namespace

EmergencyConfig load_emergency(YamlMap& yaml) {
  EmergencyConfig c;
  c.warning_time_s = yaml.number_or("warning_time", c.warning_time_s, {0.1, 10.0}, "s");
  c.braking_time_s = yaml.number_or("braking_time", c.braking_time_s, {0.05, 10.0}, "s");
  if (c.braking_time_s > c.warning_time_s)
    yaml.fail("braking_time", fmt::format("must be from 0.05 s to warning_time, which is {:g} s", c.warning_time_s));
  c.deceleration = yaml.number_or("deceleration", c.deceleration, {0.5, 15.0}, "m/s^2");
  c.known_for = yaml.duration_or("known_for", c.known_for, {Duration::milliseconds(0), Duration::milliseconds(10'000)});
  load_path(yaml, c.path);
  return c;
}

EmergencyBraking::EmergencyBraking(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                   const EmergencyConfig& config)
    : config_(config), way_(cluster, task, config.path), out_(cluster, task) {}

void EmergencyBraking::report(host::StepContext& context, WarningKind service, bool on, TrackId track,
                              double time_to_collision) {
  if (on_[index_of(service)] == on) return;
  on_[index_of(service)] = on;
  context.sink->on(recording::records::Warning{context.stamp, service, on, track, time_to_collision});
}

void EmergencyBraking::run(host::StepContext& context) {
  // A warning goes on with any track: that of the object ahead may be lost and born again meanwhile.
  const std::optional<View> view =
      way_.look(context, on_[index_of(WarningKind::kForwardCollision)] ? Duration{} : config_.known_for);
  recording::records::CommandIssued record;
  record.gap = kNone;
  record.track = kNoTrack;
  if (!view) return out_.issue(context, {}, record);
  record.own_speed = view->own_speed;
  double remaining = kNone;
  if (view->ahead) {
    remaining = time_to(*view->ahead, view->own_speed);
    record.track = view->ahead->track;
    record.gap = view->ahead->clearance;
    record.speed_ahead = view->ahead->speed;
  }
  const bool goes_on =
      on_[index_of(WarningKind::kEmergencyBraking)] && remaining < kNone && view->own_speed > kStopped_mps;
  // At a standstill the noise of the other vehicle's speed looks like an approach, with no way left. So nothing begins.
  const auto within = [&](WarningKind service, double least_s) {
    return remaining < least_s && (on_[index_of(service)] || view->own_speed > kStopped_mps);
  };
  const bool brakes = within(WarningKind::kEmergencyBraking, config_.braking_time_s) || goes_on;
  const bool warns = brakes || within(WarningKind::kForwardCollision, config_.warning_time_s);
  report(context, WarningKind::kForwardCollision, warns, record.track, remaining);
  report(context, WarningKind::kEmergencyBraking, brakes, record.track, remaining);
  if (brakes) record.reason = recording::records::CommandReason::kEmergency;
  out_.issue(context, {brakes, brakes ? -config_.deceleration : 0.0, 0.0}, record);
}

}  // namespace ttf::nodes::driving
