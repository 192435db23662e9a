#include "nodes/driving/ahead.h"

#include <cmath>

#include "nodes/host/signals.h"

namespace ttf::nodes::driving {
namespace {

// A slower vehicle says too little about its way.
constexpr double kSlowestOnCircle_mps = 3.0;

}  // namespace

std::size_t place_of(const schedules::model::Task& task, std::string_view port) {
  for (std::size_t i = 0; i < task.reads.size(); ++i)
    if (task.reads[i].port == port) return i;
  return 0;  // ports are known to be bound (schedules/model/ports.h)
}

void load_path(YamlMap& yaml, PathConfig& path) {
  path.curved = yaml.choice_or("corridor", path.curved, Choices<bool>{{"straight", false}, {"curved", true}});
  path.half_width_m = yaml.number_or("corridor_half_width", path.half_width_m, {0.1, 20.0}, "m");
  path.max_image_age = yaml.duration_or("max_image_age", path.max_image_age,
                                        {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  path.prediction =
      yaml.duration_or("prediction", path.prediction, {Duration::milliseconds(0), Duration::milliseconds(10'000)});
}

ObjectAhead predicted(const ObjectAhead& ahead, double dt_s, double way_m) {
  ObjectAhead later = ahead;
  // An object that stands has an acceleration of noise alone.
  if (ahead.speed <= 0.0) later.acceleration = 0.0;
  const bool stands = ahead.speed > 0.0 && ahead.speed + ahead.acceleration * dt_s < 0.0;
  const double moves_s = stands ? -ahead.speed / ahead.acceleration : dt_s;
  later.clearance += ahead.speed * moves_s + 0.5 * later.acceleration * moves_s * moves_s - way_m;
  later.speed = stands ? 0.0 : ahead.speed + later.acceleration * dt_s;
  if (stands) later.acceleration = 0.0;
  return later;
}

WayAhead::WayAhead(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                   const PathConfig& config)
    : config_(config), round_(cluster.round()), image_(place_of(task, "image")), odometry_(place_of(task, "odometry")),
      most_objects_(static_cast<std::size_t>(cluster.pdu(task.reads[image_].pdu).max_elements)),
      motion_(host::bind_element<4>(cluster, cluster.pdu(task.reads[odometry_].pdu),
                                    {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"})),
      signals_(fusion::bind_image(cluster, cluster.pdu(task.reads[image_].pdu))), known_(most_objects_) {}

std::optional<View> WayAhead::look(const host::StepContext& context, Duration known_for) {
  const std::optional<double> speed = speed_with_image(context, config_.max_image_age + config_.prediction);
  if (!speed) return std::nullopt;
  double curvature = 0.0;
  if (config_.curved && *speed > kSlowestOnCircle_mps) {
    const host::Input& odometry = context.inputs[odometry_];
    curvature = host::element_value(*odometry.layout, *odometry.list, 0, motion_[1]) / *speed;
  }
  const host::Input& image = context.inputs[image_];
  const double way = way_since_image(context, *speed);
  std::optional<ObjectAhead> ahead = nearest(image, curvature, known_for);
  if (ahead && !image.fresh) ahead = predicted(*ahead, (context.stamp.local - *valid_at_).seconds(), way);
  return View{*speed, ahead};
}

double WayAhead::way_since_image(const host::StepContext& context, double speed) {
  way_m_ += 0.5 * (speed_then_.value_or(speed) + speed) * (context.stamp.local - way_until_).seconds();
  way_until_ = context.stamp.local;
  speed_then_ = speed;
  return way_m_;
}

void WayAhead::list(const host::StepContext& context, std::vector<recording::records::ImageObject>& objects) const {
  const host::Input& image = context.inputs[image_];
  objects.clear();
  const int count = host::element_count(*image.layout, *image.list);
  for (int i = 0; i < count; ++i)
    objects.push_back(fusion::decode_image_object(*image.layout, *image.list, i, signals_));
}

std::optional<double> WayAhead::own_speed(const host::StepContext& context) {
  return speed_with_image(context, config_.max_image_age);
}

void WayAhead::note_image(const host::StepContext& context) {
  const host::Input& image = context.inputs[image_];
  known_.begin(context.stamp.local);
  for (int i = 0; i < host::element_count(*image.layout, *image.list); ++i) {
    const auto object = fusion::decode_image_object(*image.layout, *image.list, i, signals_);
    if (has(object.status, recording::records::ImageStatus::kConfirmed)) known_.add(object.track);
  }
  valid_at_.reset();
  if (!context.global_time) return;
  const GlobalTime valid_at = host::time_stamp(*image.layout, *image.list, context.stamp.global, round_);
  valid_at_ = way_until_ = context.stamp.local - (context.stamp.global - valid_at);
  way_m_ = 0.0;
  speed_then_.reset();
}

std::optional<double> WayAhead::speed_with_image(const host::StepContext& context, Duration oldest) {
  const host::Input& odometry = context.inputs[odometry_];
  if (context.inputs[image_].fresh) note_image(context);
  if (odometry.fresh)
    measured_at_ = host::past_time_stamp(*odometry.layout, *odometry.list, context.stamp.global, round_);
  if (!context.global_time || !valid_at_ || !odometry.list) return std::nullopt;
  if (host::element_count(*odometry.layout, *odometry.list) == 0) return std::nullopt;
  const Duration age = context.stamp.local - *valid_at_, measured = context.stamp.global - measured_at_;
  if (age > oldest || -age > config_.max_image_age) return std::nullopt;
  if (measured > config_.max_odometry_age || -measured > config_.max_odometry_age) return std::nullopt;
  return host::element_value(*odometry.layout, *odometry.list, 0, motion_[0]);
}

std::optional<ObjectAhead> WayAhead::nearest(const host::Input& image, double curvature, Duration known_for) const {
  std::optional<ObjectAhead> nearest;
  const int count = host::element_count(*image.layout, *image.list);
  for (int i = 0; i < count; ++i) {
    const recording::records::ImageObject object = fusion::decode_image_object(*image.layout, *image.list, i, signals_);
    if (!has(object.status, recording::records::ImageStatus::kConfirmed) || object.x <= 0.0) continue;
    if (known_.known_for(object.track) < known_for) continue;
    if (std::abs(object.y - 0.5 * curvature * object.x * object.x) > config_.half_width_m) continue;
    const double heading = object.heading - curvature * object.x;  // from the line of travel
    const double c = std::cos(heading), s = std::sin(heading);
    const double reach = 0.5 * (object.length * std::abs(c) + object.width * std::abs(s));
    const double clearance = object.x - reach - config_.front_m;
    if (nearest && nearest->clearance <= clearance) continue;
    nearest = ObjectAhead{object.track, clearance, object.speed * c, object.acceleration * c};
  }
  return nearest;
}

}  // namespace ttf::nodes::driving
