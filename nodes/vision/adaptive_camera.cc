#include "nodes/vision/adaptive_camera.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"
#include "nodes/host/signals.h"
#include "nodes/sensing/nearest_first.h"
#include "schedules/model/ports.h"

namespace ttf::nodes::vision {
namespace {

// A draw far below the mean is cut: no detection takes less than a tenth of it.
constexpr double kLeastShare = 0.1;

std::size_t place_of(const std::vector<schedules::model::PortBinding>& bindings, std::string_view port) {
  std::size_t place = 0;
  while (bindings.at(place).port != port) ++place;
  return place;
}

FramePlanConfig with_steps(FramePlanConfig plan, Duration step) {
  plan.shortest = schedules::sequence::occupied({}, step);
  return plan;
}

}  // namespace

AdaptiveCamera::AdaptiveCamera(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                               const AdaptiveCameraConfig& config, std::vector<SharedCamera> cameras,
                               const DetectionKey& key)
    : config_(config), key_(key), step_(cluster.cycle() * task.activation.at.repetition), round_(cluster.round()),
      holds_(step_ * (task.holds.ns / step_.ns)),
      plan_(with_steps(config.plan, step_), static_cast<int>(cameras.size())), shares_(cameras.size()) {
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
    cameras_.push_back(
        {layout.sensor, in, out, host::bind_element<5>(cluster, layout, {"left", "right", "bottom", "top", "class"}),
         host::bind_element<7>(cluster, cluster.pdu(task.writes[out].pdu),
                               {"x", "y", "sigma_x", "sigma_y", "correlation", "span", "sigma_span"}),
         shared, camera::GroundPlane(shared.calibration), GlobalTime{INT64_MIN}, std::nullopt, std::nullopt});
    for (const FixedRegion& fixed : config.regions)
      if (fixed.camera == read.port && !cameras_.back().fixed)
        cameras_.back().fixed = grown(cameras_.back(), fixed.region);
    most = std::max(most, layout.max_elements);
  }
  TTF_CHECK(cameras_.size() == cameras.size(), "{} cameras at {} ports", cameras.size(), cameras_.size());
  objects_.reserve(static_cast<std::size_t>(most));
}

void AdaptiveCamera::run(host::StepContext& context) {
  if (!context.global_time) return;  // pictures have no age
  read_regions(context);
  if (work_ && --work_->steps_left <= 0) finish(context);
  if (!work_) begin(context);
}

void AdaptiveCamera::read_regions(host::StepContext& context) {
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

// Returns the region with the least size, and within the picture; nothing if it lies outside.
std::optional<Region> AdaptiveCamera::grown(const Camera& camera, const Region& region) const {
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

void AdaptiveCamera::finish(host::StepContext& context) {
  const Work work = *work_;
  work_.reset();
  // A task that missed executions may not write what is older than the schedule says.
  if (context.stamp.local - work.begin > holds_ + Duration{step_.ns / 2}) return;
  const Camera& camera = cameras_[work.camera];
  host::Output& out = context.outputs[camera.out];
  sensing::keep_nearest(objects_, out.layout().max_elements);
  out.begin(work.picture.sequence, static_cast<int>(objects_.size()), work.picture.at);
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const camera::CameraObject& object = objects_[static_cast<std::size_t>(i)];
    const double values[] = {object.x,    object.y,         object.sigma_x(), object.sigma_y(), object.correlation(),
                             object.span, object.sigma_span};
    for (std::size_t s = 0; s < camera.signals.size(); ++s) out.set(i, camera.signals[s], values[s]);
  }
  if (!work.record.secondary) plan_.add(static_cast<int>(work.camera), work.record.took);
  recording::records::DetectionMade made = work.record;
  made.stamp = context.stamp;
  made.found = static_cast<std::uint16_t>(objects_.size());
  context.sink->on(made);
}

void AdaptiveCamera::begin(host::StepContext& context) {
  // The region of a secondary detection may be gone by now.
  while (!plan_.over() && plan_.next().secondary && !cameras_[static_cast<std::size_t>(plan_.next().sensor)].region)
    plan_.pass();
  if (plan_.over()) begin_frame(context);
  const schedules::sequence::Detection next = plan_.next();
  look(context, static_cast<std::size_t>(next.sensor), next.secondary);
  plan_.pass();
}

void AdaptiveCamera::begin_frame(host::StepContext& context) {
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    shares_[c] = cameras_[c].region ? std::min(1.0, cameras_[c].region->area() / cameras_[c].area()) : 0.0;
  plan_.begin(shares_);
  context.sink->on(recording::records::SequencePlanned{context.stamp, plan_.frame(), plan_.letters(), plan_.bound(),
                                                       plan_.length()});
}

// Begins a detection, if the camera has a picture for it.
void AdaptiveCamera::look(host::StepContext& context, std::size_t number, bool secondary) {
  Camera& camera = cameras_[number];
  host::Input& raw = context.inputs[camera.in];
  const std::optional<host::Strobe> picture = strobe_of(context, raw, camera.sensor);
  if (!picture) {
    raw.discarded = raw.fresh;
    return;
  }
  if (picture->at <= camera.looked_at || context.stamp.global - picture->at > step_ * kOldestPicture) return;
  camera.looked_at = picture->at;
  objects_.clear();
  const int count = host::element_count(*raw.layout, *raw.list);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) { return host::element_value(*raw.layout, *raw.list, i, camera.raw[s]); };
    if (secondary && !camera.region->holds(0.5 * (value(0) + value(1)), 0.5 * (value(2) + value(3)))) continue;
    objects_.push_back(camera.plane.locate({value(0), value(1), value(2), static_cast<int>(std::lround(value(4)))}));
  }
  Work work;
  work.camera = number;
  work.picture = *picture;
  work.begin = context.stamp.local;
  work.record.begin = context.stamp.true_time;
  work.record.id = {camera.sensor, picture->sequence};
  work.record.frame = plan_.frame();
  work.record.place = static_cast<std::uint16_t>(plan_.place());
  work.record.secondary = secondary;
  work.record.area = secondary ? std::min(1.0, camera.region->area() / camera.area()) : 1.0;
  work.record.took = std::min(drawn_time(camera.sensor, picture->sequence, work.record.area), holds_);
  work.steps_left = schedules::sequence::occupied(work.record.took, step_).ns / step_.ns;
  work_ = work;
}

Duration AdaptiveCamera::drawn_time(SensorId sensor, std::uint32_t picture, double share) const {
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
