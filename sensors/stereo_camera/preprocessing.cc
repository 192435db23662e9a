#include "sensors/stereo_camera/preprocessing.h"

#include "sensors/nearest_first.h"
#include "sensors/silhouette_signals.h"

namespace ttf::sensors::stereo_camera {

void write_silhouettes(nodes::host::Output& out, const nodes::host::Strobe& measurement,
                       const std::vector<std::size_t>& signals, std::vector<CameraObject>& objects) {
  keep_nearest(objects, out.layout().max_elements);
  const auto values_of = [](const CameraObject& one) {
    return std::array{one.x,
                      one.y,
                      one.sigma_x(),
                      one.sigma_y(),
                      one.correlation(),
                      one.span,
                      one.sigma_span,
                      static_cast<double>(one.class_code)};
  };
  write_list(out, measurement.sequence, measurement.at, signals, objects, values_of);
}

CameraPreprocessing::CameraPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                                         const CameraCalibration& calibration)
    : Preprocessing(cluster, task),
      raw_(nodes::host::bind_element<3>(cluster, layout_read(cluster, task, "raw"), {"bearing", "disparity", "width"})),
      signals_(bind_silhouettes(cluster, layout_written(cluster, task, "objects"))), calibration_(calibration) {
  objects_.reserve(static_cast<std::size_t>(layout_read(cluster, task, "raw").max_elements));
}

void CameraPreprocessing::process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) {
  objects_.clear();
  read_list(context.inputs[0], raw_, [&](const std::array<double, 3>& values) {
    objects_.push_back(triangulate(calibration_, values[0], values[1], values[2]));
  });
  write_silhouettes(context.outputs[0], measurement, signals_, objects_);
}

}  // namespace ttf::sensors::stereo_camera
