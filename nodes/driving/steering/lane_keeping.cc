#include "nodes/driving/steering/lane_keeping.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ttf::nodes::driving::steering {
namespace {

constexpr double kNoObject = std::numeric_limits<double>::infinity();
// Below walking pace the limit of the lateral acceleration says nothing.
constexpr double kSlowest_mps = 1.0;

}  // namespace

LaneKeepingConfig load_lane_keeping(YamlMap& yaml) {
  LaneKeepingConfig c;
  c.gains.offset = yaml.number_or("offset_gain", c.gains.offset, {0.0, 20.0}, "1/s");
  c.gains.softening_mps = yaml.number_or("softening", c.gains.softening_mps, {0.01, 50.0}, "m/s");
  c.gains.yaw_rate_s = yaml.number_or("yaw_rate_gain", c.gains.yaw_rate_s, {0.0, 2.0}, "s");
  c.preview = yaml.duration_or("preview", c.preview, {Duration{}, Duration::milliseconds(2'000)});
  c.largest_lateral = yaml.number_or("largest_lateral", c.largest_lateral, {0.1, 15.0}, "m/s^2");
  c.departure_m = yaml.number_or("departure", c.departure_m, {-1.0, 1.0}, "m");
  c.lane.width_m = yaml.number_or("lane_width", c.lane.width_m, {2.0, 6.0}, "m");
  c.lane.least_validity = yaml.number_or("least_validity", c.lane.least_validity, {0.0, 1.0});
  c.lane.max_marks_age = yaml.duration_or("max_marks_age", c.lane.max_marks_age,
                                          {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  return c;
}

LaneKeeping::LaneKeeping(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                         const LaneKeepingConfig& config)
    : config_(config), lane_(cluster, task, config.lane), out_(cluster, task) {}

double LaneKeeping::steering_for(const Lane& lane) const {
  const double speed = std::max(0.0, lane.speed);
  const LaneLine then =
      seen_from(after(lane.middle, lane.speed, lane.yaw_rate, config_.preview.seconds()), config_.wheelbase_m);
  control::StanleyInput input;
  input.direction_error = then.heading;
  input.offset = then.offset;
  input.speed = speed;
  input.yaw_rate = lane.yaw_rate;
  input.path_yaw_rate = speed * then.curvature;
  input.steady_slip = control::steady_slip(config_.load, speed, input.path_yaw_rate);
  const double fast = std::max(kSlowest_mps, speed);
  const double most = std::atan(config_.wheelbase_m * config_.largest_lateral / (fast * fast));
  return std::clamp(control::stanley_steering(config_.gains, input), -most, most);
}

void LaneKeeping::run(host::StepContext& context) {
  recording::records::CommandIssued record;
  record.gap = kNoObject;
  record.track = kNoTrack;
  const std::optional<Lane> lane = lane_.look(context);
  if (!lane) return out_.issue(context, {}, record);
  record.own_speed = lane->speed;
  record.reason = recording::records::CommandReason::kLane;
  const double offset = seen_from(lane->middle, config_.wheelbase_m).offset;
  const bool departs = 0.5 * (lane->width - config_.width_m) - std::abs(offset) < config_.departure_m;
  if (departs != departs_)
    context.sink->on(recording::records::Warning{context.stamp, recording::records::WarningKind::kLaneDeparture,
                                                 departs, kNoTrack, kNoObject});
  departs_ = departs;
  out_.issue(context, {true, 0.0, steering_for(*lane)}, record);
}

}  // namespace ttf::nodes::driving::steering
