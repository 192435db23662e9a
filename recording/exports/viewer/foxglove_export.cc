#include "recording/exports/viewer/foxglove_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "recording/exports/viewer/foxglove.pb.h"
#include "recording/exports/viewer/plots.pb.h"
#include "recording/exports/viewer/scene.h"
#include "recording/scene/geometry.h"

namespace ttf::recording::exports::viewer {
namespace {

constexpr const char* kVehicle = "vehicle";
constexpr std::uint16_t kNoTopic = 0;  // odometry has no observations
// Longer than any period of its topic that the shipped schedules have.
constexpr Duration kObjectLife = Duration::milliseconds(1000), kListLife = Duration::milliseconds(300), kForever{};

// Sensors have other colours (recording/log/sensor_style.h).
constexpr Colour kTruth{0.9, 0.9, 0.9, 1.0}, kTrack{0.94, 0.89, 0.26, 1.0}, kWarning{1.0, 0.1, 0.1, 1.0};
constexpr double kBoxOpacity = 0.4, kCoastingOpacity = 0.15;

using scene::drawable;
using scene::place_of;
using scene::within_reach;

std::string frame_of(const scene::ViewedSensor& sensor) { return fmt::format("{}/{}", kVehicle, sensor.name); }

std::string words_of(const records::FeatureObject& object) {
  if (std::isfinite(object.time_to_collision_s))
    return fmt::format("collision in {:.1f} s", object.time_to_collision_s);
  return std::isfinite(object.time_gap_s) ? fmt::format("gap of {:.1f} s", object.time_gap_s) : "warning";
}

const char* status_of(const records::ImageObject& object) {
  if (has(object.status, records::ImageStatus::kCoasting)) return "coasting";
  return has(object.status, records::ImageStatus::kConfirmed) ? "confirmed" : "tentative";
}

}  // namespace

void Shown::replace_by(::foxglove::SceneUpdate& update, TrueTime at) {
  std::set<std::string> now;
  for (const ::foxglove::SceneEntity& entity : update.entities()) now.insert(entity.id());
  for (const std::string& id : ids_) {
    if (now.contains(id)) continue;
    ::foxglove::SceneEntityDeletion& gone = *update.add_deletions();
    set_stamp(*gone.mutable_timestamp(), at);
    gone.set_type(::foxglove::SceneEntityDeletion::MATCHING_ID);
    gone.set_id(id);
  }
  ids_ = std::move(now);
}

FoxgloveExport::FoxgloveExport(const std::string& path, std::vector<scene::ViewedSensor> sensors)
    : sensors_(std::move(sensors)), file_(path) {
  const google::protobuf::Descriptor& update = *::foxglove::SceneUpdate::descriptor();
  transforms_ = file_.topic("/transforms", *::foxglove::FrameTransforms::descriptor());
  fields_ = file_.topic("/fields", update);
  truth_topic_ = file_.topic("/truth", update);
  reference_ = file_.topic("/reference", update);
  tracks_ = file_.topic("/tracks", update);
  warnings_ = file_.topic("/warnings", update);
  image_use_ = file_.topic("/image_use", *ttfusion::plots::ImageUse::descriptor());
  errors_ = file_.topic("/errors", *ttfusion::plots::Errors::descriptor());
  for (const scene::ViewedSensor& sensor : sensors_) {
    observations_.push_back(sensor.odometry ? kNoTopic : file_.topic("/observations/" + sensor.name, update));
    ages_.push_back(sensor.odometry ? kNoTopic
                                    : file_.topic("/ages/" + sensor.name, *ttfusion::plots::Age::descriptor()));
  }
  write_sensors();
}

void FoxgloveExport::write_sensors() {
  ::foxglove::FrameTransforms frames;
  ::foxglove::SceneUpdate update;
  for (const scene::ViewedSensor& sensor : sensors_) {
    if (!sensor.mounting) continue;
    ::foxglove::FrameTransform& frame = *frames.add_transforms();
    set_stamp(*frame.mutable_timestamp(), {});
    frame.set_parent_frame_id(kVehicle);
    frame.set_child_frame_id(frame_of(sensor));
    ::foxglove::Pose pose;
    set_pose(pose, *sensor.mounting);
    *frame.mutable_translation() = pose.position();
    *frame.mutable_rotation() = pose.orientation();
    if (!sensor.field) continue;
    ++counts_.fields;
    ::foxglove::SceneEntity& entity = add_entity(update, {}, frame_of(sensor), sensor.name, kForever);
    add_loop(entity, scene::edge(*sensor.field), colour_of(sensor.colour));
    add_text(entity, {sensor.field->max_range, 0.0}, sensor.name, colour_of(sensor.colour));
  }
  if (frames.transforms_size() > 0) file_.add(transforms_, {}, frames);
  if (update.entities_size() > 0) file_.add(fields_, {}, update);
}

SceneCounts FoxgloveExport::finish() {
  Moments::finish();
  file_.finish();
  return counts_;
}

void FoxgloveExport::reached(TrueTime at) { file_.write_before(at - kHeldBack); }

void FoxgloveExport::truth(TrueTime at, std::span<const records::TruthState> states) {
  ::foxglove::SceneUpdate update;
  for (const records::TruthState& state : states) {
    if (!drawable(state)) continue;
    const std::string id = fmt::format("object {}", index_of(state.object));
    ::foxglove::SceneEntity& entity = add_entity(update, at, kVehicle, id, kObjectLife);
    add_box(entity, place_of(state), state.length, state.width, with_opacity(kTruth, kBoxOpacity));
    add_text(entity, {state.x, state.y + state.width}, id, kTruth);
  }
  shown_truth_.replace_by(update, at);
  file_.add(truth_topic_, at, update);
  ++counts_.truths;
}

void FoxgloveExport::list(const scene::SeenList& list) {
  const std::size_t sensor = index_of(list.id.sensor);
  if (sensor >= sensors_.size()) {
    ++counts_.unnamed;
    return;
  }
  if (sensors_[sensor].odometry) return;
  ::foxglove::SceneUpdate update;
  ::foxglove::SceneEntity& entity = add_entity(update, list.measured, kVehicle, sensors_[sensor].name, kListLife);
  add_crosses(entity, list.points, colour_of(sensors_[sensor].colour));
  file_.add(observations_[sensor], list.measured, update);
  ++counts_.observations;
}

void FoxgloveExport::fix(TrueTime at, const records::ReferenceFix& r) {
  ::foxglove::SceneUpdate update;
  const std::string id = fmt::format("reference of object {}", index_of(r.object));
  ::foxglove::SceneEntity& entity = add_entity(update, at, kVehicle, id, kListLife);
  add_crosses(entity, std::array{scene::Point{r.x, r.y}}, kTruth);
  file_.add(reference_, at, update);
  ++counts_.references;
}

void FoxgloveExport::image(TrueTime at, const records::ImageWritten& r) {
  ::foxglove::SceneUpdate update;
  const scene::OwnMotion own = own_motion().value_or(scene::OwnMotion{});
  for (const records::ImageObject& object : r.objects) {
    if (!drawable(object)) continue;
    const bool coasting = has(object.status, records::ImageStatus::kCoasting);
    const std::string id = std::to_string(index_of(object.track));
    ::foxglove::SceneEntity& entity = add_entity(update, at, kVehicle, "track " + id, kObjectLife);
    add_box(entity, place_of(object), object.length, object.width,
            with_opacity(kTrack, coasting ? kCoastingOpacity : kBoxOpacity));
    add_way(entity, place_of(object), scene::moved_on(place_of(object), object.speed, own, 1.0), kTrack);
    if (const std::vector<scene::Point> points = scene::ellipse(object); !points.empty())
      add_loop(entity, points, kTrack);
    add_text(entity, {object.x, object.y}, id, kTrack);
    ::foxglove::KeyValuePair& status = *entity.add_metadata();
    status.set_key("status");
    status.set_value(status_of(object));
  }
  shown_tracks_.replace_by(update, at);
  file_.add(tracks_, at, update);
  ++counts_.images;
}

void FoxgloveExport::use(TrueTime at, const records::FeatureUsed& r) {
  ::foxglove::SceneUpdate update;
  for (const records::FeatureObject& object : r.objects) {
    if (!object.warning || !drawable(object.image)) continue;
    ::foxglove::SceneEntity& entity =
        add_entity(update, at, kVehicle, fmt::format("track {}", index_of(object.image.track)), kObjectLife);
    add_loop(entity, scene::rectangle(place_of(object.image), object.image.length, object.image.width), kWarning);
    add_text(entity, {object.image.x, object.image.y - object.image.width}, words_of(object), kWarning);
  }
  ttfusion::plots::ImageUse use;
  set_stamp(*use.mutable_timestamp(), at);
  use.set_image(r.image_sequence);
  if (within_reach(r.stamp.global.ns) && within_reach(r.image_valid_at.ns))
    use.set_age_ms(in_ms(r.stamp.global - r.image_valid_at));
  use.set_objects(static_cast<std::uint32_t>(r.objects.size()));
  use.set_warnings(static_cast<std::uint32_t>(std::ranges::count_if(r.objects, &records::FeatureObject::warning)));
  use.set_fresh(r.fresh);
  use.set_stale(r.stale);
  shown_warnings_.replace_by(update, at);
  file_.add(warnings_, at, update);
  file_.add(image_use_, at, use);
  ++counts_.uses;
}

void FoxgloveExport::age(TrueTime used, SensorId sensor, Duration age) {
  if (index_of(sensor) >= sensors_.size()) {
    ++counts_.unnamed;
    return;
  }
  if (sensors_[index_of(sensor)].odometry) return;
  const TrueTime at = scene::shown(used);
  ttfusion::plots::Age message;
  set_stamp(*message.mutable_timestamp(), at);
  message.set_age_ms(in_ms(age));
  file_.add(ages_[index_of(sensor)], at, message);
  ++counts_.ages;
}

void FoxgloveExport::errors(TrueTime used, std::span<const ObjectErrors> objects, std::size_t missed,
                            std::size_t spurious) {
  const TrueTime at = scene::shown(used);
  ttfusion::plots::Errors message;
  set_stamp(*message.mutable_timestamp(), at);
  double position = 0.0, velocity = 0.0;
  for (const ObjectErrors& one : objects) {
    position += one.x * one.x + one.y * one.y;
    velocity += one.vx * one.vx + one.vy * one.vy;
    ttfusion::plots::ObjectError& out = *message.add_objects();
    out.set_object(index_of(one.object));
    out.set_x_m(one.x);
    out.set_y_m(one.y);
    out.set_vx_mps(one.vx);
    out.set_vy_mps(one.vy);
    out.set_nees(one.nees);
  }
  const auto mean = [&](double sum) {
    return objects.empty() ? std::numeric_limits<double>::quiet_NaN()
                           : std::sqrt(sum / static_cast<double>(objects.size()));
  };
  message.set_position_m(mean(position));
  message.set_velocity_mps(mean(velocity));
  message.set_missed(static_cast<std::uint32_t>(missed));
  message.set_spurious(static_cast<std::uint32_t>(spurious));
  file_.add(errors_, at, message);
  ++counts_.errors;
}

}  // namespace ttf::recording::exports::viewer
