#include "nodes/driving/vehicle_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/driving/ahead.h"

namespace ttf::nodes::driving {
namespace {

// Executions that are further apart have others between them that did not happen.
Duration longest_without_a_gap(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                               Duration max_plan_age) {
  const bool timed = task.activation.kind == schedules::model::ActivationKind::kTime;
  return std::max(max_plan_age, timed ? 2 * task.activation.at.repetition * cluster.cycle() : cluster.round());
}

}  // namespace

ControlConfig load_control(YamlMap& yaml) {
  ControlConfig c;
  c.speed.kp = yaml.number_or("kp", c.speed.kp, {0.0, 100.0}, "1/s");
  c.speed.ki = yaml.number_or("ki", c.speed.ki, {0.0, 100.0}, "1/s^2");
  c.speed.tracking_s = yaml.number_or("tracking_time", c.speed.tracking_s, {0.5, 1000.0}, "s");
  c.speed.largest = yaml.number_or("largest_acceleration", c.speed.largest, {0.1, 30.0}, "m/s^2");
  c.speed.smallest = -yaml.number_or("largest_deceleration", -c.speed.smallest, {0.1, 30.0}, "m/s^2");
  c.steering.offset = yaml.number_or("offset_gain", c.steering.offset, {0.0, 100.0}, "1/s");
  c.steering.softening_mps = yaml.number_or("softening_speed", c.steering.softening_mps, {0.01, 100.0}, "m/s");
  c.steering.yaw_rate_s = yaml.number_or("yaw_rate_gain", c.steering.yaw_rate_s, {0.0, 10.0}, "s");
  c.steering.steering = yaml.number_or("steering_gain", c.steering.steering, {0.0, 1.0});
  c.steering.largest_rad = yaml.number_or("largest_steering", c.steering.largest_rad, {0.01, 1.5}, "rad");
  c.max_plan_age =
      yaml.duration_or("max_plan_age", c.max_plan_age, {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  return c;
}

VehicleControl::VehicleControl(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                               const ControlConfig& config)
    : config_(config), round_(cluster.round()), longest_(longest_without_a_gap(cluster, task, config.max_plan_age)),
      plan_(place_of(task, "plan")), signals_(bind_plan(cluster, cluster.pdu(task.reads[plan_].pdu))),
      place_(cluster, task), out_(cluster, task) {}

double VehicleControl::steering(const PoseOnLine& own) {
  control::StanleyInput input;
  input.direction_error = -own.heading;
  input.offset = -(own.offset + config_.wheelbase_m * std::sin(own.heading));
  input.speed = std::max(0.0, own.speed);
  input.yaw_rate = own.yaw_rate;
  input.steering_before = steering_before_;
  input.steering_now = steering_now_;
  steering_before_ = steering_now_;
  steering_now_ = control::stanley_steering(config_.steering, input);
  return steering_now_;
}

void VehicleControl::run(host::StepContext& context) {
  const std::optional<PoseOnLine> own = place_.look(context);
  const LocalTime now = context.stamp.local;
  const bool goes_on = context.activation > 0 && now - last_ <= longest_;
  const double dt = goes_on ? (now - last_).seconds() : 0.0;
  if (!goes_on) integral_ = 0.0;
  last_ = now;
  const host::Input& input = context.inputs[plan_];
  if (input.fresh) issued_ = host::past_time_stamp(*input.layout, *input.list, context.stamp.global, round_);
  const Plan plan = input.list ? decode_plan(*input.layout, *input.list, signals_) : Plan{};
  recording::records::CommandIssued record;
  record.gap = std::numeric_limits<double>::infinity();
  record.track = kNoTrack;
  const Duration age = context.stamp.global - issued_;
  if (!own || !plan.valid || age > config_.max_plan_age || -age > config_.max_plan_age) {
    integral_ = 0.0;
    return out_.issue(context, {}, record);
  }
  record.own_speed = own->speed;
  record.reason = recording::records::CommandReason::kPlan;
  const double acceleration = config_.speed.step(plan.speed - own->speed, dt, integral_);
  out_.issue(context, {true, acceleration, steering(*own)}, record);
}

}  // namespace ttf::nodes::driving
