#include "nodes/sensing/preprocessing.h"

#include <algorithm>
#include <cmath>

#include "nodes/host/signals.h"
#include "nodes/sensing/nearest_first.h"
#include "nodes/sensing/observation_codec.h"

namespace ttf::nodes::sensing {
namespace {

const schedules::model::PduLayout& layout_of(const schedules::model::Cluster& cluster,
                                             const std::vector<schedules::model::PortBinding>& bindings,
                                             std::string_view port) {
  return cluster.pdu(host::binding_of(bindings, port).pdu);
}

}  // namespace

LaserPreprocessing::LaserPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                       const laser::LaserPreprocessingConfig& config)
    : sensor_(layout_of(cluster, task.reads, "raw").sensor),
      raw_(host::bind_element<3>(cluster, layout_of(cluster, task.reads, "raw"), {"layer", "azimuth", "range"})),
      signals_(host::bind_element<12>(cluster, layout_of(cluster, task.writes, "objects"),
                                      {"x", "y", "heading", "length", "width", "sigma_x", "sigma_y", "correlation",
                                       "sigma_heading", "sigma_length", "sigma_width", "valid"})),
      preprocessor_(config, static_cast<std::size_t>(layout_of(cluster, task.reads, "raw").max_elements)) {
  points_.reserve(static_cast<std::size_t>(layout_of(cluster, task.reads, "raw").max_elements));
  objects_.reserve(preprocessor_.most_objects());
}

void LaserPreprocessing::run(host::StepContext& context) {
  const auto measurement = measurement_of(context, sensor_);
  if (!measurement) return;
  const host::Input& raw = context.inputs[0];
  points_.clear();
  const int count = host::element_count(*raw.layout, *raw.list);
  for (int i = 0; i < count; ++i)
    points_.push_back({static_cast<int>(std::lround(host::element_value(*raw.layout, *raw.list, i, raw_[0]))),
                       host::element_value(*raw.layout, *raw.list, i, raw_[1]),
                       host::element_value(*raw.layout, *raw.list, i, raw_[2])});
  preprocessor_.process(points_, objects_);
  host::Output& out = context.outputs[0];
  keep_nearest(objects_, out.layout().max_elements);
  out.begin(measurement->sequence, static_cast<int>(objects_.size()), measurement->at);
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const laser::LaserObject& object = objects_[static_cast<std::size_t>(i)];
    const bool corner = object.seen == ttf::fusion::sensors::SeenPoint::kCorner;
    const double valid = (object.has_heading ? kValidHeading : 0) + (object.has_length ? kValidLength : 0) +
                         (object.has_width ? kValidWidth : 0) + (corner ? kValidCorner : 0);
    const double values[] = {object.x,
                             object.y,
                             object.heading,
                             object.length,
                             object.width,
                             object.sigma_x(),
                             object.sigma_y(),
                             object.correlation(),
                             object.sigma_heading,
                             object.sigma_length,
                             object.sigma_width,
                             valid};
    for (std::size_t s = 0; s < signals_.size(); ++s)
      if (s == 9 || s == 10)  // the sizes' uncertainties, of the order of the resolution
        out.set_at_least(i, signals_[s], values[s]);
      else
        out.set(i, signals_[s], values[s]);
  }
}

CameraPreprocessing::CameraPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                         const camera::CameraCalibration& calibration)
    : sensor_(layout_of(cluster, task.reads, "raw").sensor),
      raw_(host::bind_element<3>(cluster, layout_of(cluster, task.reads, "raw"), {"bearing", "disparity", "width"})),
      signals_(host::bind_element<7>(cluster, layout_of(cluster, task.writes, "objects"),
                                     {"x", "y", "sigma_x", "sigma_y", "correlation", "span", "sigma_span"})),
      calibration_(calibration) {
  objects_.reserve(static_cast<std::size_t>(layout_of(cluster, task.reads, "raw").max_elements));
}

void CameraPreprocessing::run(host::StepContext& context) {
  const auto measurement = measurement_of(context, sensor_);
  if (!measurement) return;
  const host::Input& raw = context.inputs[0];
  objects_.clear();
  const int count = host::element_count(*raw.layout, *raw.list);
  for (int i = 0; i < count; ++i)
    objects_.push_back(triangulate(calibration_, host::element_value(*raw.layout, *raw.list, i, raw_[0]),
                                   host::element_value(*raw.layout, *raw.list, i, raw_[1]),
                                   host::element_value(*raw.layout, *raw.list, i, raw_[2])));
  host::Output& out = context.outputs[0];
  keep_nearest(objects_, out.layout().max_elements);
  out.begin(measurement->sequence, static_cast<int>(objects_.size()), measurement->at);
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    const camera::CameraObject& object = objects_[static_cast<std::size_t>(i)];
    const double values[] = {object.x,    object.y,         object.sigma_x(), object.sigma_y(), object.correlation(),
                             object.span, object.sigma_span};
    for (std::size_t s = 0; s < signals_.size(); ++s) out.set(i, signals_[s], values[s]);
  }
}

RadarPreprocessing::RadarPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                       const radar::RadarPreprocessingConfig& config)
    : sensor_(layout_of(cluster, task.reads, "raw").sensor),
      raw_(host::bind_element<4>(cluster, layout_of(cluster, task.reads, "raw"),
                                 {"range", "azimuth", "range_rate", "power"})),
      signals_(host::bind_element<7>(
          cluster, layout_of(cluster, task.writes, "objects"),
          {"range", "bearing", "range_rate", "sigma_range", "sigma_bearing", "sigma_range_rate", "returns"})),
      joiner_(config, static_cast<std::size_t>(layout_of(cluster, task.reads, "raw").max_elements)) {
  returns_.reserve(static_cast<std::size_t>(layout_of(cluster, task.reads, "raw").max_elements));
  objects_.reserve(static_cast<std::size_t>(layout_of(cluster, task.reads, "raw").max_elements));
}

// The joiner's objects are by range: the nearest ones stay. More returns than the layout can say count as many as it can.
void RadarPreprocessing::run(host::StepContext& context) {
  const auto measurement = measurement_of(context, sensor_);
  if (!measurement) return;
  const host::Input& raw = context.inputs[0];
  returns_.clear();
  const int count = host::element_count(*raw.layout, *raw.list);
  for (int i = 0; i < count; ++i)
    returns_.push_back({host::element_value(*raw.layout, *raw.list, i, raw_[0]),
                        host::element_value(*raw.layout, *raw.list, i, raw_[1]),
                        host::element_value(*raw.layout, *raw.list, i, raw_[2])});
  joiner_.join(returns_, objects_);
  host::Output& out = context.outputs[0];
  const int listed = std::min(static_cast<int>(objects_.size()), out.layout().max_elements);
  out.begin(measurement->sequence, listed, measurement->at);
  for (int i = 0; i < listed; ++i) {
    const radar::RadarObject& object = objects_[static_cast<std::size_t>(i)];
    const double values[] = {object.range, object.bearing, object.range_rate};
    const double sigmas[] = {object.sigma_range, object.sigma_bearing, object.sigma_range_rate};
    for (std::size_t s = 0; s < 3; ++s) out.set(i, signals_[s], values[s]);
    for (std::size_t s = 0; s < 3; ++s) out.set_at_least(i, signals_[3 + s], sigmas[s]);
    out.set(i, signals_[6], std::min<double>(object.returns, out.layout().element[signals_[6]].high));
  }
}

}  // namespace ttf::nodes::sensing
