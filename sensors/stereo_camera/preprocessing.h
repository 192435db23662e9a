// The host's preprocessing of a stereo camera's detections.
#pragma once

#include <array>
#include <vector>

#include "sensors/preprocessing.h"
#include "sensors/stereo_camera/triangulation.h"

namespace ttf::sensors::stereo_camera {

// Writes the nearest silhouettes, as many as the list holds. `signals` are those of the layout (sensors/silhouette_signals.h).
void write_silhouettes(nodes::host::Output& out, const nodes::host::Strobe& measurement,
                       const std::vector<std::size_t>& signals, std::vector<CameraObject>& objects);

// Ports: `raw` (bearing, disparity, width) -> `objects` (position and its covariance, span of the silhouette).
class CameraPreprocessing final : public Preprocessing {
 public:
  CameraPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                      const CameraCalibration& calibration);

 private:
  void process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) override;

  std::array<std::size_t, 3> raw_;
  std::vector<std::size_t> signals_;
  CameraCalibration calibration_;
  std::vector<CameraObject> objects_;
};

}  // namespace ttf::sensors::stereo_camera
