#include "bus/dds/ros/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/int128.h"

namespace ttf::bus::dds::ros {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kPpm = 1'000'000;

char* text_of(const std::string& text) { return const_cast<char*>(text.c_str()); }
char* text_of(const char* text) { return const_cast<char*>(text); }

template <class Sequence, class Element> void refer(Sequence& sequence, std::vector<Element>& elements) {
  sequence._buffer = elements.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(elements.size());
  sequence._release = false;
}

geometry_msgs_msg_dds__Pose_ pose_of(double x, double y, double heading) {
  return {.position = {.x = x, .y = y, .z = 0},
          .orientation = {.x = 0, .y = 0, .z = std::sin(heading / 2), .w = std::cos(heading / 2)}};
}

ttfusion_msgs_msg_dds__ImageObject_ message_of(const recording::records::ImageObject& object) {
  return {.track_id = static_cast<std::uint16_t>(object.track),
          .status = static_cast<std::uint8_t>(object.status),
          .x = object.x,
          .y = object.y,
          .heading = object.heading,
          .speed = object.speed,
          .acceleration = object.acceleration,
          .length = object.length,
          .width = object.width,
          .sigma_x = object.sigma_x,
          .sigma_y = object.sigma_y,
          .correlation_xy = object.correlation_xy,
          .sigma_heading = object.sigma_heading,
          .sigma_speed = object.sigma_speed,
          .sigma_acceleration = object.sigma_acceleration,
          .sigma_length = object.sigma_length,
          .sigma_width = object.sigma_width};
}

vision_msgs_msg_dds__ObjectHypothesisWithPose_ hypothesis_of(const recording::records::ImageObject& object) {
  vision_msgs_msg_dds__ObjectHypothesisWithPose_ hypothesis{};
  const bool confirmed = has(object.status, recording::records::ImageStatus::kConfirmed);
  hypothesis.hypothesis = {.class_id = text_of(confirmed ? "confirmed" : "tentative"), .score = 1};
  hypothesis.pose.pose = pose_of(object.x, object.y, object.heading);
  double(&covariance)[36] = hypothesis.pose.covariance;  // row-major, of x, y, z and the rotations about X, Y, Z
  covariance[0 * 6 + 0] = object.sigma_x * object.sigma_x;
  covariance[0 * 6 + 1] = covariance[1 * 6 + 0] = object.correlation_xy * object.sigma_x * object.sigma_y;
  covariance[1 * 6 + 1] = object.sigma_y * object.sigma_y;
  covariance[5 * 6 + 5] = object.sigma_heading * object.sigma_heading;
  return hypothesis;
}

}  // namespace

builtin_interfaces_msg_dds__Time_ ros_time(std::int64_t realtime_ns) {
  const std::int64_t rest = ((realtime_ns % kSecond) + kSecond) % kSecond;
  const std::int64_t seconds = realtime_ns / kSecond - (realtime_ns % kSecond < 0 ? 1 : 0);
  constexpr std::int64_t kFirst = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int32_t>::max();
  if (seconds < kFirst) return {.sec = static_cast<std::int32_t>(kFirst), .nanosec = 0};
  if (seconds > kLast) return {.sec = static_cast<std::int32_t>(kLast), .nanosec = kSecond - 1};
  return {.sec = static_cast<std::int32_t>(seconds), .nanosec = static_cast<std::uint32_t>(rest)};
}

std::int64_t realtime_at(std::int64_t origin_ns, TrueTime drive, std::int64_t scale_ppm) {
  using Limits = std::numeric_limits<std::int64_t>;
  const Int128 product = Int128{drive.ns} * scale_ppm;
  const Int128 since = product / kPpm - (product % kPpm < 0 ? 1 : 0);
  return static_cast<std::int64_t>(std::clamp<Int128>(origin_ns + since, Limits::min(), Limits::max()));
}

std::string object_name(ObjectId object) { return fmt::format("object_{}", index_of(object)); }

Messages::Messages(const RosOptions& options)
    : origin_(options.origin_realtime_ns), scale_ppm_(options.time_scale_ppm), frame_(options.frame_id),
      hardware_(options.node_name) {}

builtin_interfaces_msg_dds__Time_ Messages::time_of(TrueTime at) const {
  return ros_time(realtime_at(origin_, at, scale_ppm_));
}

std_msgs_msg_dds__Header_ Messages::header(TrueTime at) { return {.stamp = time_of(at), .frame_id = text_of(frame_)}; }

const ttfusion_msgs_msg_dds__RealTimeImage_& Messages::image(const WaitingImage& waiting) {
  objects_.clear();
  for (const recording::records::ImageObject& object : waiting.objects) objects_.push_back(message_of(object));
  image_.header = header(waiting.valid_at);
  image_.sequence_number = waiting.sequence;
  image_.written = time_of(waiting.written);
  image_.newest_measurement = {};
  if (waiting.newest_measurement) image_.newest_measurement = time_of(*waiting.newest_measurement);
  refer(image_.objects, objects_);
  return image_;
}

const vision_msgs_msg_dds__Detection3DArray_& Messages::boxes(const WaitingImage& waiting) {
  hypotheses_.clear();
  ids_.clear();
  detections_.clear();
  for (const recording::records::ImageObject& object : waiting.objects) {
    hypotheses_.push_back(hypothesis_of(object));
    *fmt::format_to_n(ids_.emplace_back().data(), 7, "{}", index_of(object.track)).out = '\0';
  }
  for (std::size_t i = 0; i < waiting.objects.size(); ++i) {  // the vectors they refer to no longer move
    vision_msgs_msg_dds__Detection3D_& detection = detections_.emplace_back();
    detection.header = header(waiting.valid_at);
    detection.results = {._maximum = 1, ._length = 1, ._buffer = &hypotheses_[i], ._release = false};
    detection.bbox.center = hypotheses_[i].pose.pose;
    detection.bbox.size = {.x = waiting.objects[i].length, .y = waiting.objects[i].width, .z = 0};
    detection.id = ids_[i].data();
  }
  boxes_.header = header(waiting.valid_at);
  refer(boxes_.detections, detections_);
  return boxes_;
}

const ttfusion_msgs_msg_dds__TrackArray_& Messages::tracks(const WaitingStep& waiting) {
  tracks_.clear();
  for (const WaitingTrack& track : waiting.tracks) {
    ttfusion_msgs_msg_dds__Track_& message = tracks_.emplace_back();
    message.track_id = static_cast<std::uint16_t>(track.id);
    message.valid_at = time_of(track.valid_at);
    std::copy(track.state.begin(), track.state.end(), message.state);
    std::copy(track.covariance.begin(), track.covariance.end(), message.covariance);
  }
  track_array_.header = header(waiting.at);
  track_array_.step = waiting.step;
  track_array_.confirmed = waiting.confirmed;
  track_array_.tentative = waiting.tentative;
  refer(track_array_.tracks, tracks_);
  return track_array_;
}

const nav_msgs_msg_dds__Odometry_& Messages::truth(const WaitingTruth& waiting) {
  const recording::records::TruthState& state = waiting.state;
  child_frame_ = object_name(state.object);
  odometry_.header = header(state.at);
  odometry_.child_frame_id = text_of(child_frame_);
  odometry_.pose.pose = pose_of(state.x, state.y, state.heading);
  odometry_.twist.twist.linear.x = state.speed;
  odometry_.twist.twist.angular.z = state.yaw_rate;
  return odometry_;
}

const diagnostic_msgs_msg_dds__DiagnosticArray_& Messages::health(const WaitingHealth& waiting) {
  const char* next = waiting.text.data();
  const auto take = [&next] {
    const char* text = next;
    next += std::char_traits<char>::length(text) + 1;
    return text_of(text);
  };
  status_.level = static_cast<std::uint8_t>(waiting.level);
  status_.name = take();
  status_.message = take();
  status_.hardware_id = text_of(hardware_);
  values_.clear();
  for (std::size_t i = 0; i < waiting.values; ++i) {
    diagnostic_msgs_msg_dds__KeyValue_& value = values_.emplace_back();
    value.key = take();
    value.value = take();
  }
  refer(status_.values, values_);
  diagnostics_.header = header(waiting.at);
  diagnostics_.status = {._maximum = 1, ._length = 1, ._buffer = &status_, ._release = false};
  return diagnostics_;
}

}  // namespace ttf::bus::dds::ros
