#include "nodes/sensing/mono_camera.h"

#include <algorithm>
#include <cmath>

#include "nodes/host/signals.h"
#include "nodes/sensing/nearest_first.h"

namespace ttf::nodes::sensing {
namespace {

const schedules::model::PduLayout& boxes_of(const schedules::model::Cluster& cluster,
                                            const std::vector<schedules::model::PortBinding>& bindings) {
  return cluster.pdu(host::binding_of(bindings, "raw").pdu);
}

// Returns the index of a binding, if the task has it.
std::optional<std::size_t> place_of_port(const std::vector<schedules::model::PortBinding>& bindings,
                                         std::string_view port) {
  for (std::size_t p = 0; p < bindings.size(); ++p)
    if (bindings[p].port == port) return p;
  return std::nullopt;
}

}  // namespace

MonoCameraEmulator::MonoCameraEmulator(const EmulatorConfig& config, const sim::world::MonoCameraConfig& camera)
    : config_(config), camera_(sim::world::in_drive(
                           camera, {config.seed, config.replication, static_cast<std::uint16_t>(config.sensor)})),
      signals_(host::bind_element<5>(*config.cluster, boxes_of(*config.cluster, config.task->writes),
                                     {"left", "right", "bottom", "top", "class"})),
      raw_port_(*place_of_port(config.task->writes, "raw")), room_(config.scene->objects()) {
  camera_.max_boxes = boxes_of(*config.cluster, config.task->writes).max_elements;
  states_.reserve(config.scene->objects());
  boxes_.reserve(static_cast<std::size_t>(camera_.max_boxes));
  truth_.reserve(static_cast<std::size_t>(camera_.max_boxes));
  if (const auto port = place_of_port(config.task->writes, "marks")) {
    const schedules::model::PduLayout& layout = config.cluster->pdu(config.task->writes[*port].pdu);
    marks_.emplace().port = *port;
    marks_->signals = host::bind_element<3>(*config.cluster, layout, {"offset", "heading", "curvature"});
    marks_->there.reserve(sim::world::LaneMarkConfig::kMost);
    marks_->seen.reserve(static_cast<std::size_t>(layout.max_elements));
    marks_->truth.reserve(static_cast<std::size_t>(layout.max_elements));
  }
}

void MonoCameraEmulator::run(host::StepContext& context) {
  const TrueTime at = sim::world::measured_at(context.stamp.true_time, camera_.device);
  config_.scene->states_at(at, states_);
  sim::world::see_from(camera_.device.placement, states_);
  sim::world::measure_mono_camera(camera_, states_, config_.seed, config_.replication,
                                  static_cast<std::uint16_t>(config_.sensor), context.measurement, room_, boxes_,
                                  truth_);
  if (marks_) {
    host::Output& out = context.outputs[marks_->port];
    marks_->there.clear();
    if (const sim::world::road::Road* road = config_.scene->road()) {
      const sim::world::EgoState ego = config_.scene->ego_at(at);
      for (std::size_t m = 0; m < road->marks() && m < sim::world::LaneMarkConfig::kMost; ++m) {
        const auto mark = road->mark_at(m, {ego.x, ego.y, ego.heading}, camera_.marks.ahead_m);
        marks_->there.push_back({mark.offset, mark.heading, mark.curvature});
      }
    }
    sim::world::measure_lane_marks(camera_.marks, marks_->there, config_.seed, config_.replication,
                                   static_cast<std::uint16_t>(config_.sensor), context.measurement,
                                   static_cast<std::size_t>(out.layout().max_elements), marks_->seen, marks_->truth);
    out.begin(context.measurement, static_cast<int>(marks_->seen.size()), GlobalTime{});
    for (int i = 0; i < static_cast<int>(marks_->seen.size()); ++i) {
      const sim::world::LaneMark& mark = marks_->seen[static_cast<std::size_t>(i)];
      const double values[] = {mark.offset, mark.heading, mark.curvature};
      for (std::size_t s = 0; s < 3; ++s) out.set(i, marks_->signals[s], values[s]);
    }
  }
  host::Output& raw = context.outputs[raw_port_];
  const auto count = static_cast<int>(boxes_.size());
  raw.begin(context.measurement, count, GlobalTime{});
  for (int i = 0; i < count; ++i) {
    const sim::world::MonoBox& box = boxes_[static_cast<std::size_t>(i)];
    const double values[] = {box.left, box.right, box.bottom, box.top, static_cast<double>(box.seen_as)};
    for (std::size_t s = 0; s < signals_.size(); ++s) raw.set(i, signals_[s], values[s]);
  }
  recording::records::Measured measured;
  measured.stamp = context.stamp;
  measured.id = {config_.sensor, context.measurement};
  measured.truth_ids = truth_;
  context.sink->on(measured);
}

MonoCameraPreprocessing::MonoCameraPreprocessing(const schedules::model::Cluster& cluster,
                                                 const schedules::model::Task& task,
                                                 const camera::MonoCalibration& calibration)
    : sensor_(boxes_of(cluster, task.reads).sensor),
      raw_(host::bind_element<5>(cluster, boxes_of(cluster, task.reads), {"left", "right", "bottom", "top", "class"})),
      signals_(host::bind_element<7>(cluster, cluster.pdu(host::binding_of(task.writes, "objects").pdu),
                                     {"x", "y", "sigma_x", "sigma_y", "correlation", "span", "sigma_span"})),
      plane_(calibration), objects_port_(*place_of_port(task.writes, "objects")) {
  objects_.reserve(static_cast<std::size_t>(boxes_of(cluster, task.reads).max_elements));
  const auto in = place_of_port(task.reads, "marks"), out = place_of_port(task.writes, "lanes");
  if (!in || !out) return;
  // The boxes' strobe is that of the marks (nodes/host/step.h: measurement_of).
  if (*in == 0)
    throw InputError(
        cluster.finding(task.line, "reads.marks", cluster.pdu(task.reads[*in].pdu).name, "must follow raw"));
  const schedules::model::PduLayout& marks = cluster.pdu(task.reads[*in].pdu);
  const auto most = static_cast<std::size_t>(marks.max_elements);
  lanes_.emplace(ListedLanes{*in,
                             *out,
                             host::bind_element<3>(cluster, marks, {"offset", "heading", "curvature"}),
                             host::bind_element<7>(cluster, cluster.pdu(task.writes[*out].pdu),
                                                   {"offset", "heading", "curvature", "sigma_offset", "sigma_heading",
                                                    "sigma_curvature", "validity"}),
                             calibration.marks,
                             camera::MarkMemory(most),
                             {}});
  lanes_->marks.reserve(most);
}

void MonoCameraPreprocessing::run(host::StepContext& context) {
  const auto measurement = measurement_of(context, sensor_);
  if (!measurement) return;
  if (lanes_) run_lanes(context, *measurement);
  const host::Input& raw = context.inputs[0];
  objects_.clear();
  const int count = host::element_count(*raw.layout, *raw.list);
  for (int i = 0; i < count; ++i) {
    const auto value = [&](std::size_t s) { return host::element_value(*raw.layout, *raw.list, i, raw_[s]); };
    objects_.push_back(plane_.locate({value(0), value(1), value(2), static_cast<int>(std::lround(value(4)))}));
  }
  host::Output& out = context.outputs[objects_port_];
  keep_nearest(objects_, out.layout().max_elements);
  out.begin(measurement->sequence, static_cast<int>(objects_.size()), measurement->at);
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const camera::CameraObject& object = objects_[static_cast<std::size_t>(i)];
    const double values[] = {object.x,    object.y,         object.sigma_x(), object.sigma_y(), object.correlation(),
                             object.span, object.sigma_span};
    for (std::size_t s = 0; s < signals_.size(); ++s) out.set(i, signals_[s], values[s]);
  }
}

void MonoCameraPreprocessing::run_lanes(host::StepContext& context, const host::Strobe& measurement) {
  const host::Input& in = context.inputs[lanes_->in];
  lanes_->marks.clear();
  if (in.fresh && in.list && in.list->sequence == context.inputs[0].list->sequence) {
    const int count = host::element_count(*in.layout, *in.list);
    for (int i = 0; i < count; ++i) {
      const auto value = [&](std::size_t s) { return host::element_value(*in.layout, *in.list, i, lanes_->raw[s]); };
      lanes_->marks.push_back({value(0), value(1), value(2), 0.0});
    }
  }
  lanes_->memory.judge(lanes_->marks);
  host::Output& out = context.outputs[lanes_->out];
  const int listed = std::min(static_cast<int>(lanes_->marks.size()), out.layout().max_elements);
  out.begin(measurement.sequence, listed, measurement.at);
  const camera::MarkCalibration& k = lanes_->calibration;
  for (int i = 0; i < listed; ++i) {
    const camera::SeenMark& mark = lanes_->marks[static_cast<std::size_t>(i)];
    const double values[] = {mark.offset,      mark.heading,        mark.curvature,
                             k.offset_sigma_m, k.heading_sigma_rad, k.curvature_sigma_per_m,
                             mark.validity};
    for (std::size_t s = 0; s < lanes_->signals.size(); ++s) out.set(i, lanes_->signals[s], values[s]);
  }
}

}  // namespace ttf::nodes::sensing
