#include "sensors/stereo_camera/emulator.h"

namespace ttf::sensors::stereo_camera {

CameraEmulator::CameraEmulator(const EmulatorConfig& config, const CameraConfig& camera)
    : Emulator(config), camera_(in_drive(camera, config.drive())),
      signals_(nodes::host::bind_element<3>(*config.cluster, config.written("raw"), {"bearing", "disparity", "width"})),
      room_(config.scene->objects()) {
  camera_.max_detections = config.written("raw").max_elements;
  detections_.reserve(static_cast<std::size_t>(camera_.max_detections));
}

void CameraEmulator::run(nodes::host::StepContext& context) {
  look(context, camera_.device);
  measure_camera(camera_, states_, key(context), room_, detections_, truth_);
  write_list(context.outputs[0], context.measurement, GlobalTime{}, signals_, detections_,
             [](const CameraDetection& one) {
               return std::array{one.bearing, one.disparity, one.width_px};
             });
  record(context);
}

}  // namespace ttf::sensors::stereo_camera
