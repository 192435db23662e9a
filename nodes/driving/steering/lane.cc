#include "nodes/driving/steering/lane.h"

#include <cmath>

#include "nodes/driving/ahead.h"
#include "nodes/host/signals.h"

namespace ttf::nodes::driving::steering {
namespace {

// Marks further than this from their expected place belong to another lane, or to none.
constexpr double kMostApart_m = 0.8;

double taken_up(double from, double to) { return from + OwnLane::kGain * (to - from); }

}  // namespace

LaneLine seen_from(const LaneLine& line, double x) {
  return {line.offset + x * (line.heading + 0.5 * line.curvature * x), line.heading + line.curvature * x,
          line.curvature};
}

LaneLine after(const LaneLine& line, double speed, double yaw_rate, double seconds) {
  const double way = speed * seconds, turn = yaw_rate * seconds;
  LaneLine now = seen_from(line, way);
  now.offset -= 0.5 * way * turn;
  now.heading -= turn;
  return now;
}

OwnLane::OwnLane(const schedules::model::Cluster& cluster, const schedules::model::Task& task, const LaneConfig& config)
    : config_(config), round_(cluster.round()), marks_(place_of(task, "marks")), odometry_(place_of(task, "odometry")),
      mark_signals_(host::bind_element<7>(
          cluster, cluster.pdu(task.reads[marks_].pdu),
          {"offset", "heading", "curvature", "sigma_offset", "sigma_heading", "sigma_curvature", "validity"})),
      motion_signals_(host::bind_element<4>(cluster, cluster.pdu(task.reads[odometry_].pdu),
                                            {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"})),
      width_(config.width_m) {}

std::optional<Lane> OwnLane::look(const host::StepContext& context) {
  const GlobalTime now = context.stamp.global;
  const host::Input& marks = context.inputs[marks_];
  const host::Input& odometry = context.inputs[odometry_];
  if (odometry.fresh) measured_at_ = host::past_time_stamp(*odometry.layout, *odometry.list, now, round_);
  const bool measured = odometry.list && host::element_count(*odometry.layout, *odometry.list) > 0 &&
                        now - measured_at_ <= config_.max_odometry_age &&
                        measured_at_ - now <= config_.max_odometry_age;
  if (!context.global_time || !measured) {
    line_.reset();
    return std::nullopt;
  }
  Lane lane;
  lane.speed = host::element_value(*odometry.layout, *odometry.list, 0, motion_signals_[0]);
  lane.yaw_rate = host::element_value(*odometry.layout, *odometry.list, 0, motion_signals_[1]);
  if (line_ && now - seen_at_ > config_.max_marks_age) line_.reset();
  if (marks.fresh) {
    const GlobalTime seen_at = host::past_time_stamp(*marks.layout, *marks.list, now, round_);
    const bool fits = now - seen_at <= config_.max_marks_age && seen_at - now <= config_.max_marks_age &&
                      (!line_ || seen_at > seen_at_);
    std::optional<LaneLine> expected;
    if (line_ && fits)
      expected = seen_from(after(*line_, lane.speed, lane.yaw_rate, (seen_at - seen_at_).seconds()), config_.ahead_m);
    if (const auto found = fits ? matched(marks, expected) : std::nullopt) {
      line_ = seen_from(*found, -config_.ahead_m);
      seen_at_ = seen_at;
    }
  }
  if (!line_) return std::nullopt;
  lane.middle = after(*line_, lane.speed, lane.yaw_rate, (now - seen_at_).seconds());
  lane.width = width_;
  return lane;
}

// Returns the lane's middle where marks are measured. It lies between the nearest marks to either side of the vehicle,
// or of its expected place. One mark is enough.
std::optional<LaneLine> OwnLane::matched(const host::Input& marks, const std::optional<LaneLine>& expected) {
  const double middle = expected ? expected->offset : 0.0;
  std::optional<LaneLine> left, right;
  const int count = host::element_count(*marks.layout, *marks.list);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) {
      return host::element_value(*marks.layout, *marks.list, i, mark_signals_[s]);
    };
    // A validity is rounded on the bus.
    if (value(6) < config_.least_validity - 0.01) continue;
    const LaneLine mark{value(0), value(1), value(2)};
    const double aside = mark.offset - middle;
    const double apart = std::abs(aside) - 0.5 * width_;
    if (apart > kMostApart_m || (expected && apart < -kMostApart_m)) continue;
    std::optional<LaneLine>& nearest = aside > 0.0 ? left : right;
    if (!nearest || std::abs(aside) < std::abs(nearest->offset - middle)) nearest = mark;
  }
  if (!left && !right) return std::nullopt;
  LaneLine seen;
  if (left && right) {
    width_ = taken_up(width_, left->offset - right->offset);
    seen = {0.5 * (left->offset + right->offset), 0.5 * (left->heading + right->heading),
            0.5 * (left->curvature + right->curvature)};
  } else {
    seen = left ? *left : *right;
    seen.offset += left ? -0.5 * width_ : 0.5 * width_;
  }
  if (!expected) return seen;
  return LaneLine{taken_up(expected->offset, seen.offset), taken_up(expected->heading, seen.heading),
                  taken_up(expected->curvature, seen.curvature)};
}

}  // namespace ttf::nodes::driving::steering
