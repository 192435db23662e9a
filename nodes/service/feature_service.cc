#include "nodes/service/feature_service.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nodes/host/signals.h"

namespace ttf::nodes::service {
namespace {

// Returns the distance from the origin to the outline of a rectangle, towards its centre; zero within it.
double clearance(const recording::records::ImageObject& object, double range) {
  const double aspect = object.heading - std::atan2(object.y, object.x);
  // Half the chord along the line of sight, which leaves the rectangle through the sides or through the ends.
  constexpr double kAlongTheSides = 1e-9;
  const double through_ends = 0.5 * object.length / std::max(kAlongTheSides, std::abs(std::cos(aspect)));
  const double through_sides = 0.5 * object.width / std::max(kAlongTheSides, std::abs(std::sin(aspect)));
  return std::max(0.0, range - std::min(through_ends, through_sides));
}

}  // namespace

FeatureConfig load_feature(YamlMap& yaml) {
  FeatureConfig config;
  config.own_speed_mps = yaml.number_or("own_speed", config.own_speed_mps, {0.0, 100.0}, "m/s");
  config.corridor_half_width_m = yaml.number_or("corridor_half_width", config.corridor_half_width_m, {0.1, 20.0}, "m");
  config.warning_time_s = yaml.number_or("warning_time", config.warning_time_s, {0.1, 10.0}, "s");
  config.max_image_age = yaml.duration_or("max_image_age", config.max_image_age,
                                          {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  return config;
}

recording::records::FeatureObject judge(const recording::records::ImageObject& object, const FeatureConfig& config,
                                        std::optional<double> measured_speed) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  // A slower approach than walking pace is no collision course: the sign of a speed near zero is noise.
  constexpr double kSlowestClosing_mps = 0.5;
  recording::records::FeatureObject result;
  result.image = object;
  const double range = std::hypot(object.x, object.y), distance = clearance(object, range);
  const double own_speed = measured_speed.value_or(config.own_speed_mps);
  const double vx = object.speed * std::cos(object.heading) - measured_speed.value_or(0.0);
  const double vy = object.speed * std::sin(object.heading);
  const double closing = range > 0.0 ? -(vx * object.x + vy * object.y) / range : 0.0;
  result.time_gap_s = own_speed > 0.0 && object.x > 0.0 ? distance / own_speed : kNone;
  result.time_to_collision_s = closing > kSlowestClosing_mps ? distance / closing : kNone;
  result.warning = object.x > 0.0 && std::abs(object.y) <= config.corridor_half_width_m &&
                   result.time_to_collision_s < config.warning_time_s;
  return result;
}

FeatureService::FeatureService(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                               const FeatureConfig& config)
    : config_(config), round_(cluster.round()) {
  const schedules::model::PduLayout& layout = cluster.pdu(host::binding_of(task.reads, "image").pdu);
  signals_ = fusion::bind_image(cluster, layout);
  for (std::size_t i = 0; i < task.reads.size(); ++i) {
    if (task.reads[i].port == "image") image_ = i;
    if (task.reads[i].port != "odometry") continue;
    odometry_ = i;
    speed_ = host::bind_element<4>(cluster, cluster.pdu(task.reads[i].pdu),
                                   {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"})[0];
  }
  objects_.reserve(static_cast<std::size_t>(layout.max_elements));
}

void FeatureService::run(host::StepContext& context) {
  const host::Input& image = context.inputs[image_];
  if (!image.list) return;  // without an image the service does nothing
  if (image.fresh) valid_at_ = host::time_stamp(*image.layout, *image.list, context.stamp.global, round_);
  const Duration age = context.stamp.global - valid_at_;
  const bool stale = age > config_.max_image_age || -age > config_.max_image_age;
  objects_.clear();
  std::optional<double> speed;
  if (odometry_)
    if (const host::Input& odometry = context.inputs[*odometry_];
        odometry.list && host::element_count(*odometry.layout, *odometry.list) > 0)
      speed = host::element_value(*odometry.layout, *odometry.list, 0, speed_);
  const bool judges = !stale && (!odometry_ || speed);
  const int count = judges ? host::element_count(*image.layout, *image.list) : 0;
  for (int i = 0; i < count; ++i)
    objects_.push_back(judge(fusion::decode_image_object(*image.layout, *image.list, i, signals_), config_, speed));
  recording::records::FeatureUsed used;
  used.stamp = context.stamp;
  used.image_sequence = image.list->sequence;
  used.image_valid_at = valid_at_;
  used.fresh = image.fresh;
  used.stale = stale;
  used.objects = objects_;
  context.sink->on(used);
}

}  // namespace ttf::nodes::service
