#include "sensors/mono_camera/preprocessing.h"

#include <algorithm>
#include <cmath>

#include "sensors/silhouette_signals.h"
#include "sensors/stereo_camera/preprocessing.h"

namespace ttf::sensors::mono_camera {

MonoCameraPreprocessing::MonoCameraPreprocessing(const schedules::model::Cluster& cluster,
                                                 const schedules::model::Task& task, const MonoCalibration& calibration)
    : Preprocessing(cluster, task), raw_(nodes::host::bind_element<5>(cluster, layout_read(cluster, task, "raw"),
                                                                      {"left", "right", "bottom", "top", "class"})),
      signals_(bind_silhouettes(cluster, layout_written(cluster, task, "objects"))), plane_(calibration),
      objects_port_(*place_of_port(task.writes, "objects")) {
  objects_.reserve(static_cast<std::size_t>(layout_read(cluster, task, "raw").max_elements));
  const auto in = place_of_port(task.reads, "marks"), out = place_of_port(task.writes, "lanes");
  if (!in || !out) return;
  const schedules::model::PduLayout& marks = layout_read(cluster, task, "marks");
  // The boxes' strobe is that of the marks (nodes/host/step.h: measurement_of).
  if (*in == 0) throw InputError(cluster.finding(task.line, "reads.marks", marks.name, "must follow raw"));
  const auto most = static_cast<std::size_t>(marks.max_elements);
  lanes_.emplace(ListedLanes{*in,
                             *out,
                             nodes::host::bind_element<3>(cluster, marks, {"offset", "heading", "curvature"}),
                             nodes::host::bind_element<7>(cluster, layout_written(cluster, task, "lanes"),
                                                          {"offset", "heading", "curvature", "sigma_offset",
                                                           "sigma_heading", "sigma_curvature", "validity"}),
                             calibration.marks,
                             MarkMemory(most),
                             {}});
  lanes_->marks.reserve(most);
}

void MonoCameraPreprocessing::process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) {
  if (lanes_) process_lanes(context, measurement);
  objects_.clear();
  read_list(context.inputs[0], raw_, [&](const std::array<double, 5>& values) {
    objects_.push_back(plane_.locate({values[0], values[1], values[2], static_cast<int>(std::lround(values[4]))}));
  });
  write_silhouettes(context.outputs[objects_port_], measurement, signals_, objects_);
}

void MonoCameraPreprocessing::process_lanes(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) {
  const nodes::host::Input& in = context.inputs[lanes_->in];
  lanes_->marks.clear();
  if (in.fresh && in.list && in.list->sequence == context.inputs[0].list->sequence)
    read_list(in, lanes_->raw, [&](const std::array<double, 3>& values) {
      lanes_->marks.push_back({values[0], values[1], values[2], 0.0});
    });
  lanes_->memory.judge(lanes_->marks);
  nodes::host::Output& out = context.outputs[lanes_->out];
  const int listed = std::min(static_cast<int>(lanes_->marks.size()), out.layout().max_elements);
  out.begin(measurement.sequence, listed, measurement.at);
  const MarkCalibration& k = lanes_->calibration;
  for (int i = 0; i < listed; ++i) {
    const SeenMark& mark = lanes_->marks[static_cast<std::size_t>(i)];
    const double values[] = {mark.offset,      mark.heading,        mark.curvature,
                             k.offset_sigma_m, k.heading_sigma_rad, k.curvature_sigma_per_m,
                             mark.validity};
    for (std::size_t s = 0; s < lanes_->signals.size(); ++s) out.set(i, lanes_->signals[s], values[s]);
  }
}

}  // namespace ttf::sensors::mono_camera
