#include "nodes/driving/blind_spot_warning.h"

#include <cmath>
#include <limits>

#include "nodes/host/signals.h"

namespace ttf::nodes::driving {

BlindSpotConfig load_blind_spot(YamlMap& yaml) {
  BlindSpotConfig c;
  c.ahead_m = yaml.number_or("ahead", c.ahead_m, {-5.0, 10.0}, "m");
  c.behind_m = yaml.number_or("behind", c.behind_m, {0.0, 50.0}, "m");
  if (c.behind_m <= -c.ahead_m) yaml.fail("behind", "must lie behind `ahead`");
  c.nearest_m = yaml.number_or("nearest", c.nearest_m, {0.0, 10.0}, "m");
  c.furthest_m = yaml.number_or("furthest", c.furthest_m, {0.1, 20.0}, "m");
  if (c.furthest_m <= c.nearest_m) yaml.fail("furthest", "must be more than `nearest`");
  c.margin_m = yaml.number_or("margin", c.margin_m, {0.0, 5.0}, "m");
  c.max_image_age =
      yaml.duration_or("max_image_age", c.max_image_age, {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  return c;
}

BlindSpotWarning::BlindSpotWarning(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                   const BlindSpotConfig& config)
    : config_(config), round_(cluster.round()),
      signals_(fusion::bind_image(cluster, cluster.pdu(host::binding_of(task.reads, "image").pdu))) {}

// Returns the nearest confirmed object in the zone; kNoTrack without one.
TrackId BlindSpotWarning::found(const host::Input& image, double side, double margin) const {
  TrackId nearest = kNoTrack;
  double aside = std::numeric_limits<double>::infinity();
  const int count = host::element_count(*image.layout, *image.list);
  for (int i = 0; i < count; ++i) {
    const recording::records::ImageObject object = fusion::decode_image_object(*image.layout, *image.list, i, signals_);
    if (!has(object.status, recording::records::ImageStatus::kConfirmed)) continue;
    const double c = std::abs(std::cos(object.heading)), s = std::abs(std::sin(object.heading));
    const double along = 0.5 * (object.length * c + object.width * s) + margin,
                 across = 0.5 * (object.length * s + object.width * c) + margin;
    if (object.x - along > config_.ahead_m || object.x + along < -config_.behind_m) continue;
    const double off = side * object.y - 0.5 * config_.width_m;
    if (off + across < config_.nearest_m || off - across > config_.furthest_m || off >= aside) continue;
    nearest = object.track;
    aside = off;
  }
  return nearest;
}

void BlindSpotWarning::run(host::StepContext& context) {
  using recording::records::WarningKind;
  const host::Input& image = context.inputs[0];
  if (image.fresh) valid_at_ = host::time_stamp(*image.layout, *image.list, context.stamp.global, round_);
  const Duration ahead = valid_at_ - context.stamp.global;
  if (!context.global_time || !image.list || ahead > config_.max_image_age || -ahead > config_.max_image_age) return;
  for (const std::size_t right : {0u, 1u}) {
    bool& on = on_[right];
    const TrackId track = found(image, right == 0 ? 1.0 : -1.0, on ? config_.margin_m : 0.0);
    if ((track != kNoTrack) == on) continue;
    on = !on;
    context.sink->on(recording::records::Warning{
        context.stamp, right == 0 ? WarningKind::kBlindSpotLeft : WarningKind::kBlindSpotRight, on, track,
        std::numeric_limits<double>::infinity()});
  }
}

}  // namespace ttf::nodes::driving
