#include "recording/exports/viewer/foxglove_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "recording/exports/viewer/foxglove.pb.h"
#include "recording/exports/viewer/plots.pb.h"
#include "recording/exports/viewer/scene.h"

namespace ttf::recording::exports::viewer {
namespace {

constexpr const char* kVehicle = "vehicle";
// Longer than any period of its topic that the shipped schedules have.
constexpr Duration kObjectLife = Duration::milliseconds(1000), kListLife = Duration::milliseconds(300), kForever{};
constexpr double kEllipseSigmas = 2.0;
constexpr int kEllipsePoints = 24, kArcPoints = 32;

// Sensors have other colours (recording/log/sensor_style.h).
constexpr Colour kTruth{0.9, 0.9, 0.9, 1.0}, kTrack{0.94, 0.89, 0.26, 1.0}, kWarning{1.0, 0.1, 0.1, 1.0};
constexpr double kBoxOpacity = 0.4, kCoastingOpacity = 0.15;

template <class Object> bool drawable(const Object& object) {
  return std::isfinite(object.x) && std::isfinite(object.y) && std::isfinite(object.heading) &&
         std::isfinite(object.length) && std::isfinite(object.width);
}
template <class Object> Place place_of(const Object& object) { return {object.x, object.y, object.heading}; }

std::string frame_of(const ViewedSensor& sensor) { return fmt::format("{}/{}", kVehicle, sensor.name); }

// Returns the instant of a node's global time, if that is near the record's own instant, as in every sound log.
TrueTime instant_of(const records::Stamp& stamp, GlobalTime at) {
  if (!within_reach(stamp.true_time.ns) || !within_reach(stamp.global.ns) || !within_reach(at.ns))
    return shown(stamp.true_time);
  const Duration ahead = at - stamp.global;
  constexpr Duration kNear = FoxgloveExport::kHeldBack;
  return shown(ahead > kNear || ahead < -kNear ? stamp.true_time : stamp.true_time + ahead);
}

// The outline of a Gaussian in the plane; empty if a damaged log has none.
std::vector<Point> ellipse(const records::ImageObject& object) {
  if (!std::isfinite(object.sigma_x) || !std::isfinite(object.sigma_y)) return {};
  const double rest = std::sqrt(std::max(0.0, 1.0 - object.correlation_xy * object.correlation_xy));
  std::vector<Point> points;
  for (int k = 0; k < kEllipsePoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kEllipsePoints, c = std::cos(angle), s = std::sin(angle);
    points.push_back({object.x + kEllipseSigmas * object.sigma_x * c,
                      object.y + kEllipseSigmas * object.sigma_y * (object.correlation_xy * c + rest * s)});
  }
  return points;
}

std::vector<Point> outline(const records::ImageObject& object) {
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  const double l = 0.5 * object.length, w = 0.5 * object.width;
  std::vector<Point> points;
  for (const auto& [along, across] : std::array<std::pair<double, double>, 4>{{{l, w}, {-l, w}, {-l, -w}, {l, -w}}})
    points.push_back({object.x + c * along - s * across, object.y + s * along + c * across});
  return points;
}

// The edge of a field: an arc at its longest range, and back at its shortest.
std::vector<Point> edge(const ViewedField& field) {
  const bool all_around = field.half_angle >= std::numbers::pi;
  const double half = all_around ? std::numbers::pi : field.half_angle;
  std::vector<Point> points;
  const auto arc = [&](double range, double from, double to) {
    for (int k = 0; k <= kArcPoints; ++k) {
      const double angle = from + (to - from) * k / kArcPoints;
      points.push_back({range * std::cos(angle), range * std::sin(angle)});
    }
  };
  arc(field.max_range, -half, half);
  if (all_around) return points;
  if (field.min_range > 0.0)
    arc(field.min_range, half, -half);
  else
    points.push_back({});
  return points;
}

std::string words_of(const records::FeatureObject& object) {
  if (std::isfinite(object.time_to_collision_s))
    return fmt::format("collision in {:.1f} s", object.time_to_collision_s);
  return std::isfinite(object.time_gap_s) ? fmt::format("gap of {:.1f} s", object.time_gap_s) : "warning";
}

const char* status_of(const records::ImageObject& object) {
  if ((object.status & records::kImageCoasting) != 0) return "coasting";
  return (object.status & records::kImageConfirmed) != 0 ? "confirmed" : "tentative";
}

}  // namespace

FoxgloveExport::FoxgloveExport(const std::string& path, std::vector<ViewedSensor> sensors)
    : sensors_(std::move(sensors)), file_(path) {
  const google::protobuf::Descriptor& scene = *::foxglove::SceneUpdate::descriptor();
  transforms_ = file_.topic("/transforms", *::foxglove::FrameTransforms::descriptor());
  fields_ = file_.topic("/fields", scene);
  truth_topic_ = file_.topic("/truth", scene);
  reference_ = file_.topic("/reference", scene);
  tracks_ = file_.topic("/tracks", scene);
  warnings_ = file_.topic("/warnings", scene);
  image_use_ = file_.topic("/image_use", *ttfusion::plots::ImageUse::descriptor());
  errors_ = file_.topic("/errors", *ttfusion::plots::Errors::descriptor());
  for (const ViewedSensor& sensor : sensors_) {
    observations_.push_back(file_.topic("/observations/" + sensor.name, scene));
    ages_.push_back(file_.topic("/ages/" + sensor.name, *ttfusion::plots::Age::descriptor()));
  }
  write_sensors();
}

void FoxgloveExport::write_sensors() {
  ::foxglove::FrameTransforms frames;
  ::foxglove::SceneUpdate update;
  for (const ViewedSensor& sensor : sensors_) {
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
    add_loop(entity, edge(*sensor.field), sensor.colour);
    add_text(entity, {sensor.field->max_range, 0.0}, sensor.name, sensor.colour);
  }
  if (frames.transforms_size() > 0) file_.add(transforms_, {}, frames);
  if (update.entities_size() > 0) file_.add(fields_, {}, update);
}

SceneCounts FoxgloveExport::finish() {
  write_truth();
  write_list();
  file_.finish();
  return counts_;
}

// Records come in the order of time: what another instant had is complete.
void FoxgloveExport::come_to(TrueTime at) {
  if (!truth_.empty() && truth_.front().at != at) write_truth();
  if (list_ && list_->stamp.true_time != at) write_list();
  file_.write_before(shown(at) - kHeldBack);
}

// Every node that recorded the truth of an instant has the same: the first node's is kept.
void FoxgloveExport::on(const records::TruthState& r) {
  come_to(r.at);
  if (truth_.empty() || truth_.front().node == r.node) truth_.push_back(r);
}

void FoxgloveExport::write_truth() {
  if (truth_.empty()) return;
  const TrueTime at = shown(truth_.front().at);
  ::foxglove::SceneUpdate update;
  for (const records::TruthState& state : truth_) {
    if (!drawable(state)) continue;
    const std::string id = fmt::format("object {}", index_of(state.object));
    ::foxglove::SceneEntity& entity = add_entity(update, at, kVehicle, id, kObjectLife);
    add_box(entity, place_of(state), state.length, state.width, with_opacity(kTruth, kBoxOpacity));
    add_text(entity, {state.x, state.y + state.width}, id, kTruth);
  }
  shown_truth_.replace_by(update, at);
  file_.add(truth_topic_, at, update);
  ++counts_.truths;
  truth_.clear();
}

void FoxgloveExport::on(const records::ObservationSeen& r) {
  come_to(r.stamp.true_time);
  if (list_ && (list_->id != r.id || list_->stamp.node != r.stamp.node)) write_list();
  if (!list_) list_ = List{r.stamp, r.id, instant_of(r.stamp, r.measured), {}};
  if (std::isfinite(r.x) && std::isfinite(r.y)) list_->points.push_back({r.x, r.y});
}

void FoxgloveExport::write_list() {
  if (!list_) return;
  const List list = *std::exchange(list_, std::nullopt);
  const std::size_t sensor = index_of(list.id.sensor);
  if (sensor >= sensors_.size()) {
    ++counts_.unnamed;
    return;
  }
  ::foxglove::SceneUpdate update;
  ::foxglove::SceneEntity& entity = add_entity(update, list.measured, kVehicle, sensors_[sensor].name, kListLife);
  add_crosses(entity, list.points, sensors_[sensor].colour);
  file_.add(observations_[sensor], list.measured, update);
  ++counts_.observations;
}

void FoxgloveExport::on(const records::ReferenceFix& r) {
  come_to(r.measured_true);
  if (!std::isfinite(r.x) || !std::isfinite(r.y)) return;
  const TrueTime at = shown(r.measured_true);
  ::foxglove::SceneUpdate update;
  const std::string id = fmt::format("reference of object {}", index_of(r.object));
  ::foxglove::SceneEntity& entity = add_entity(update, at, kVehicle, id, kListLife);
  add_crosses(entity, std::array{Point{r.x, r.y}}, kTruth);
  file_.add(reference_, at, update);
  ++counts_.references;
}

void FoxgloveExport::on(const records::ImageWritten& r) {
  come_to(r.stamp.true_time);
  const TrueTime at = instant_of(r.stamp, r.valid_at);
  ::foxglove::SceneUpdate update;
  for (const records::ImageObject& object : r.objects) {
    if (!drawable(object)) continue;
    const bool coasting = (object.status & records::kImageCoasting) != 0;
    const std::string id = std::to_string(index_of(object.track));
    ::foxglove::SceneEntity& entity = add_entity(update, at, kVehicle, "track " + id, kObjectLife);
    add_box(entity, place_of(object), object.length, object.width,
            with_opacity(kTrack, coasting ? kCoastingOpacity : kBoxOpacity));
    add_velocity(entity, place_of(object), object.speed, kTrack);
    if (const std::vector<Point> points = ellipse(object); !points.empty()) add_loop(entity, points, kTrack);
    add_text(entity, {object.x, object.y}, id, kTrack);
    ::foxglove::KeyValuePair& status = *entity.add_metadata();
    status.set_key("status");
    status.set_value(status_of(object));
  }
  shown_tracks_.replace_by(update, at);
  file_.add(tracks_, at, update);
  ++counts_.images;
}

void FoxgloveExport::on(const records::FeatureUsed& r) {
  come_to(r.stamp.true_time);
  const TrueTime at = shown(r.stamp.true_time);
  ::foxglove::SceneUpdate update;
  for (const records::FeatureObject& object : r.objects) {
    if (!object.warning || !drawable(object.image)) continue;
    ::foxglove::SceneEntity& entity =
        add_entity(update, at, kVehicle, fmt::format("track {}", index_of(object.image.track)), kObjectLife);
    add_loop(entity, outline(object.image), kWarning);
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
  const TrueTime at = shown(used);
  ttfusion::plots::Age message;
  set_stamp(*message.mutable_timestamp(), at);
  message.set_age_ms(in_ms(age));
  file_.add(ages_[index_of(sensor)], at, message);
  ++counts_.ages;
}

void FoxgloveExport::errors(TrueTime used, std::span<const ObjectErrors> objects, std::size_t missed,
                            std::size_t spurious) {
  const TrueTime at = shown(used);
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
