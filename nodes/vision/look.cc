#include "nodes/vision/look.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"
#include "nodes/host/signals.h"
#include "schedules/model/ports.h"
#include "sensors/nearest_first.h"

namespace ttf::nodes::vision {
namespace {

// A draw far below the mean is cut: no detection takes less than a tenth of it.
constexpr double kLeastShare = 0.1;

std::size_t place_of(const std::vector<schedules::model::PortBinding>& bindings, std::string_view port) {
  std::size_t place = 0;
  while (bindings.at(place).port != port) ++place;
  return place;
}

}  // namespace

Looking::Looking(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                 const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras, const DetectionKey& key,
                 Duration step)
    : config_(config), key_(key), step_(step), round_(cluster.round()) {
  int most = 0;
  for (std::size_t in = 0; in < task.reads.size(); ++in) {
    const schedules::model::PortBinding& read = task.reads[in];
    const schedules::model::PduLayout& layout = cluster.pdu(read.pdu);
    if (read.port == "regions") {
      regions_.emplace(RegionPort{in, bind_regions(cluster, layout), {}, {}});
      regions_->newest.reserve(static_cast<std::size_t>(layout.max_elements));
      continue;
    }
    const std::size_t out = place_of(task.writes, schedules::model::written_port(read.port));
    const SharedCamera& shared = cameras.at(cameras_.size());
    cameras_.push_back({layout.sensor, in, out,
                        host::bind_element<5>(cluster, layout, {"left", "right", "bottom", "top", "class"}),
                        host::bind_element<7>(cluster, cluster.pdu(task.writes[out].pdu),
                                              {"x", "y", "sigma_x", "sigma_y", "correlation", "span", "sigma_span"}),
                        shared, sensors::mono_camera::GroundPlane(shared.calibration), GlobalTime{INT64_MIN},
                        std::nullopt, std::nullopt});
    for (const FixedRegion& fixed : config.regions)
      if (fixed.camera == read.port && !cameras_.back().fixed)
        cameras_.back().fixed = grown(cameras_.back(), fixed.region);
    most = std::max(most, layout.max_elements);
  }
  TTF_CHECK(cameras_.size() == cameras.size(), "{} cameras at {} ports", cameras.size(), cameras_.size());
  objects_.reserve(static_cast<std::size_t>(most));
}

void Looking::read_regions(host::StepContext& context) {
  if (!regions_) {
    for (Camera& camera : cameras_) camera.region = camera.fixed;
    return;
  }
  host::Input& input = context.inputs[regions_->in];
  if (input.fresh && input.list) {
    decode_regions(*input.layout, *input.list, regions_->signals, regions_->newest);
    regions_->issued = host::past_time_stamp(*input.layout, *input.list, context.stamp.global, round_);
  }
  const Duration age = context.stamp.global - regions_->issued;
  const bool counts = age <= config_.oldest_region && -age <= config_.oldest_region;
  if (!counts && input.fresh) input.discarded = true;
  for (Camera& camera : cameras_) {
    camera.region.reset();
    const auto first = std::ranges::find(regions_->newest, camera.sensor, &Region::sensor);
    if (counts && first != regions_->newest.end()) camera.region = grown(camera, *first);
  }
}

double Looking::share(std::size_t number) const {
  const Camera& camera = cameras_[number];
  return camera.region ? std::min(1.0, camera.region->area() / camera.area()) : 0.0;
}

// Returns the region with the least size, and within the picture; nothing if it lies outside.
std::optional<Region> Looking::grown(const Camera& camera, const Region& region) const {
  const auto side = [&](double& from, double& size, double half) {
    const double more = std::max(0.0, config_.smallest_region_px - size);
    const double low = std::max(from - 0.5 * more, -half), high = std::min(from + size + 0.5 * more, half);
    from = low;
    size = high - low;
    return size > 0.0;
  };
  Region result = region;
  const bool wide = side(result.x, result.width, camera.picture.half_width_px);
  const bool high = side(result.y, result.height, camera.picture.half_height_px);
  if (!wide || !high) return std::nullopt;
  return result;
}

std::optional<Look> Looking::look(host::StepContext& context, std::size_t number, bool secondary, Duration longest) {
  Camera& camera = cameras_[number];
  host::Input& raw = context.inputs[camera.in];
  const std::optional<host::Strobe> picture = strobe_of(context, raw, camera.sensor);
  if (!picture) {
    raw.discarded = raw.fresh;
    return std::nullopt;
  }
  if (picture->at <= camera.looked_at || context.stamp.global - picture->at > step_ * kOldestPicture)
    return std::nullopt;
  camera.looked_at = picture->at;
  objects_.clear();
  const int count = host::element_count(*raw.layout, *raw.list);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) { return host::element_value(*raw.layout, *raw.list, i, camera.raw[s]); };
    if (secondary && !camera.region->holds(0.5 * (value(0) + value(1)), 0.5 * (value(2) + value(3)))) continue;
    objects_.push_back(camera.plane.locate({value(0), value(1), value(2), static_cast<int>(std::lround(value(4)))}));
  }
  Look look;
  look.camera = number;
  look.picture = *picture;
  look.record.begin = context.stamp.true_time;
  look.record.id = {camera.sensor, picture->sequence};
  look.record.secondary = secondary;
  look.record.area = secondary ? share(number) : 1.0;
  look.record.took = std::min(drawn_time(camera.sensor, picture->sequence, look.record.area), longest);
  return look;
}

void Looking::write(host::StepContext& context, const Look& look) {
  const Camera& camera = cameras_[look.camera];
  host::Output& out = context.outputs[camera.out];
  sensors::keep_nearest(objects_, out.layout().max_elements);
  out.begin(look.picture.sequence, static_cast<int>(objects_.size()), look.picture.at);
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const sensors::stereo_camera::CameraObject& object = objects_[static_cast<std::size_t>(i)];
    const double values[] = {object.x,    object.y,         object.sigma_x(), object.sigma_y(), object.correlation(),
                             object.span, object.sigma_span};
    for (std::size_t s = 0; s < camera.signals.size(); ++s) out.set(i, camera.signals[s], values[s]);
  }
  recording::records::DetectionMade made = look.record;
  made.stamp = context.stamp;
  made.found = static_cast<std::uint16_t>(objects_.size());
  context.sink->on(made);
}

Duration Looking::drawn_time(SensorId sensor, std::uint32_t picture, double share) const {
  RandomStream draw(
      {key_.seed, key_.replication, Purpose::kDetectionTime, static_cast<std::uint16_t>(index_of(sensor)), picture});
  const double relative = std::max(kLeastShare, 1.0 + config_.deviation * draw.normal());
  const double whole = config_.hardware_factor * static_cast<double>(config_.picture_time.ns);
  return Duration::nanoseconds(std::llround(whole * share * relative));
}

Duration whole_picture(const AdaptiveCameraConfig& config) {
  return Duration::nanoseconds(std::llround(config.hardware_factor * static_cast<double>(config.picture_time.ns)));
}

}  // namespace ttf::nodes::vision
