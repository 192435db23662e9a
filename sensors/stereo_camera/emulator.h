// A stereo camera as a device.
#pragma once

#include <array>
#include <vector>

#include "sensors/emulator.h"
#include "sensors/stereo_camera/model.h"

namespace ttf::sensors::stereo_camera {

// Port `raw`: detections as bearing [rad], disparity [px], width [px].
class CameraEmulator final : public Emulator {
 public:
  CameraEmulator(const EmulatorConfig& config, const CameraConfig& camera);
  void run(nodes::host::StepContext& context) override;

 private:
  CameraConfig camera_;
  std::array<std::size_t, 3> signals_;
  CameraRoom room_;
  std::vector<CameraDetection> detections_;
};

}  // namespace ttf::sensors::stereo_camera
