#include "recording/osi/osi_export.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/common.h>

#include <cctype>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "recording/mcap/bytes.h"
#include "recording/osi/messages.h"
#include "recording/osi/osi.pb.h"
#include "recording/scene/geometry.h"
#include "recording/scene/instants.h"

namespace ttf::recording::osi {
namespace {

constexpr std::uint32_t kMajor = 3, kMinor = 8, kPatch = 0;

struct Version {
  std::uint32_t major = 0, minor = 0, patch = 0;
  std::string text(const char* between) const { return fmt::format("{1}{0}{2}{0}{3}", between, major, minor, patch); }
};
constexpr Version kOsi{kMajor, kMinor, kPatch};
constexpr Version kProtobuf{GOOGLE_PROTOBUF_VERSION / 1'000'000, GOOGLE_PROTOBUF_VERSION / 1'000 % 1'000,
                            GOOGLE_PROTOBUF_VERSION % 1'000};

template <class Message> void begin(Message& message, TrueTime at) {
  message.mutable_version()->set_version_major(kMajor);
  message.mutable_version()->set_version_minor(kMinor);
  message.mutable_version()->set_version_patch(kPatch);
  message.mutable_timestamp()->set_seconds(at.ns / kNsPerSecond);
  message.mutable_timestamp()->set_nanos(static_cast<std::uint32_t>(at.ns % kNsPerSecond));
}

void set(osi3::Vector3d& vector, double x, double y) {
  vector.set_x(x);
  vector.set_y(y);
  vector.set_z(0.0);
}

// Speed and acceleration are along the heading, `across` is the acceleration to the left of it.
struct Box {
  double x, y, heading, speed, acceleration, length, width, across = 0.0;
};
template <class Object> Box box_of(const Object& object) {
  return {object.x, object.y, object.heading, object.speed, object.acceleration, object.length, object.width};
}
// A true object drives along its heading, which turns with its yaw rate.
Box true_box_of(const records::TruthState& state) {
  Box box = box_of(state);
  box.across = state.speed * state.yaw_rate;
  return box;
}

void set_base(osi3::BaseMoving& base, const Box& box) {
  const double c = std::cos(box.heading), s = std::sin(box.heading);
  base.mutable_dimension()->set_length(box.length);
  base.mutable_dimension()->set_width(box.width);
  set(*base.mutable_position(), box.x, box.y);
  base.mutable_orientation()->set_yaw(box.heading);
  set(*base.mutable_velocity(), box.speed * c, box.speed * s);
  set(*base.mutable_acceleration(), box.acceleration * c - box.across * s, box.acceleration * s + box.across * c);
}

// Returns the box over ground; places in the log are in the axes of the vehicle.
Box over_ground(Box box, const records::EgoTruth& ego) {
  const double c = std::cos(ego.heading), s = std::sin(ego.heading), x = box.x, y = box.y;
  box.x = ego.x + c * x - s * y;
  box.y = ego.y + s * x + c * y;
  box.heading += ego.heading;
  return box;
}

// The vehicle's size is not in the log. This is a passenger car's (the paper's Touran), with the rear axle behind its middle.
constexpr double kCarLength_m = 4.39, kCarWidth_m = 1.79, kRearToMiddle_m = 1.35;

// The middle of the box is before the middle of the rear axle, r, so that it has the velocity w x r and the acceleration -w^2 r
// beside those of the axle. The axle turns, too: it has the acceleration w v to the left. A log has no changes of the yaw rate
// and of the speed across.
void add_host(osi3::GroundTruth& message, const records::EgoTruth& ego) {
  message.mutable_host_vehicle_id()->set_value(kHostVehicle);
  osi3::MovingObject& host = *message.add_moving_object();
  host.mutable_id()->set_value(kHostVehicle);
  osi3::BaseMoving& base = *host.mutable_base();
  set_base(base, over_ground({kRearToMiddle_m, 0.0, 0.0, 0.0, 0.0, kCarLength_m, kCarWidth_m}, ego));
  const double c = std::cos(ego.heading), s = std::sin(ego.heading), w = ego.yaw_rate;
  const double across = ego.vy + w * kRearToMiddle_m, acceleration = ego.acceleration - w * w * kRearToMiddle_m;
  set(*base.mutable_velocity(), c * ego.vx - s * across, s * ego.vx + c * across);
  const double turning = w * ego.vx;
  set(*base.mutable_acceleration(), c * acceleration - s * turning, s * acceleration + c * turning);
  base.mutable_orientation_rate()->set_yaw(w);
  host.set_type(osi3::MovingObject::TYPE_VEHICLE);
  set(*host.mutable_vehicle_attributes()->mutable_bbcenter_to_rear(), -kRearToMiddle_m, 0.0);
}

bool finite(const records::EgoTruth& ego) {
  return std::isfinite(ego.x + ego.y + ego.heading + ego.vx + ego.vy + ego.yaw_rate + ego.acceleration);
}

// OSI has velocities of detected objects relative to the vehicle.
void make_relative(osi3::BaseMoving& base, const scene::OwnMotion& own) {
  osi3::Vector3d& velocity = *base.mutable_velocity();
  set(velocity, velocity.x() - own.speed + own.yaw_rate * base.position().y(),
      velocity.y() - own.yaw_rate * base.position().x());
}

// The deviations of a vector along the heading, whose size and direction have deviations of their own, to first order.
void set_deviations(osi3::Vector3d& vector, double heading, double size, double sigma, double sigma_heading) {
  const double c = std::cos(heading), s = std::sin(heading), across = size * sigma_heading;
  set(vector, std::hypot(c * sigma, s * across), std::hypot(s * sigma, c * across));
}

std::string bytes_of(const google::protobuf::MessageLite& message) {
  std::string bytes;
  TTF_CHECK(message.SerializeToString(&bytes), "{}", message.GetTypeName());
  return bytes;
}

}  // namespace

OsiExport::OsiExport(Write sensor_data, Write ground_truth)
    : sensor_data_(std::move(sensor_data)), ground_truth_(std::move(ground_truth)) {}

void OsiExport::truth(TrueTime at, std::span<const records::TruthState> states) {
  if (at <= last_truth_) {
    ++counts_.left_out;
    return;
  }
  last_truth_ = at;
  osi3::GroundTruth message;
  begin(message, at);
  const records::EgoTruth ego = finite(Moments::ego()) ? Moments::ego() : records::EgoTruth{};
  add_host(message, ego);
  for (const records::TruthState& state : states) {
    if (!scene::drawable(state)) continue;
    osi3::MovingObject& object = *message.add_moving_object();
    object.mutable_id()->set_value(index_of(state.object));
    set_base(*object.mutable_base(), over_ground(true_box_of(state), ego));
    object.mutable_base()->mutable_orientation_rate()->set_yaw(state.yaw_rate);
    object.set_type(osi3::MovingObject::TYPE_OTHER);  // the log does not say
  }
  ground_truth_(at, bytes_of(message));
  ++counts_.truths;
}

void OsiExport::image(TrueTime valid_at, const records::ImageWritten& image) {
  if (valid_at <= last_image_) {
    ++counts_.left_out;
    return;
  }
  last_image_ = valid_at;
  osi3::SensorData message;
  begin(message, valid_at);
  message.mutable_sensor_id()->set_value(1);
  set(*message.mutable_mounting_position()->mutable_position(), 0.0, 0.0);
  message.mutable_mounting_position()->mutable_orientation()->set_yaw(0.0);
  const TrueTime newest = scene::instant_of(image.stamp, image.newest_measurement);
  message.mutable_last_measurement_time()->set_seconds(newest.ns / kNsPerSecond);
  message.mutable_last_measurement_time()->set_nanos(static_cast<std::uint32_t>(newest.ns % kNsPerSecond));
  osi3::DetectedEntityHeader& header = *message.mutable_moving_object_header();
  *header.mutable_measurement_time() = message.last_measurement_time();
  header.set_cycle_counter(image.sequence);
  header.set_data_qualifier(osi3::DetectedEntityHeader::DATA_QUALIFIER_AVAILABLE);
  for (const records::ImageObject& track : image.objects) {
    if (!scene::drawable(track)) continue;
    osi3::DetectedMovingObject& object = *message.add_moving_object();
    object.mutable_header()->mutable_tracking_id()->set_value(index_of(track.track));
    object.mutable_header()->set_measurement_state(has(track.status, records::ImageStatus::kCoasting)
                                                       ? osi3::DetectedItemHeader::MEASUREMENT_STATE_PREDICTED
                                                       : osi3::DetectedItemHeader::MEASUREMENT_STATE_MEASURED);
    set_base(*object.mutable_base(), box_of(track));
    if (own_motion()) make_relative(*object.mutable_base(), *own_motion());
    osi3::BaseMoving& rmse = *object.mutable_base_rmse();
    rmse.mutable_dimension()->set_length(track.sigma_length);
    rmse.mutable_dimension()->set_width(track.sigma_width);
    set(*rmse.mutable_position(), track.sigma_x, track.sigma_y);
    rmse.mutable_orientation()->set_yaw(track.sigma_heading);
    set_deviations(*rmse.mutable_velocity(), track.heading, track.speed, track.sigma_speed, track.sigma_heading);
    set_deviations(*rmse.mutable_acceleration(), track.heading, track.acceleration, track.sigma_acceleration,
                   track.sigma_heading);
    object.set_reference_point(osi3::DetectedMovingObject::REFERENCE_POINT_CENTER);
  }
  sensor_data_(valid_at, bytes_of(message));
  ++counts_.images;
}

OsiChannels declare_osi(log::LogWriter& log) {
  const std::string osi = kOsi.text("."), protobuf = kProtobuf.text(".");
  log.add_foreign_metadata("net.asam.osi.trace", {{"version", osi},
                                                  {"min_osi_version", osi},
                                                  {"max_osi_version", osi},
                                                  {"min_protobuf_version", protobuf},
                                                  {"max_protobuf_version", protobuf},
                                                  {"data_sources", "ttfusion"}});
  const mcap::McapWriter::Entries versions{{"net.asam.osi.trace.channel.osi_version", osi},
                                           {"net.asam.osi.trace.channel.protobuf_version", protobuf}};
  OsiChannels channels;
  channels.sensor_data = log.add_foreign_channel("/osi/sensor_data", *osi3::SensorData::descriptor(), versions);
  channels.ground_truth = log.add_foreign_channel("/osi/ground_truth", *osi3::GroundTruth::descriptor(), versions);
  return channels;
}

std::string osi_file_name(std::string_view type, std::uint64_t messages, std::string_view name) {
  std::string plain;
  for (const char c : name) plain += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return fmt::format("19700101T000000Z_{}_{}_{}_{}_{}.osi", type, kOsi.text(""), kProtobuf.text(""), messages, plain);
}

std::string framed(std::string_view message) {
  std::string bytes;
  mcap::put(bytes, static_cast<std::uint32_t>(message.size()));
  return bytes.append(message);
}

}  // namespace ttf::recording::osi
