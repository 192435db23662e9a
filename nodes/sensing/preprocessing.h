// Preprocessing: raw sensor data in, observation lists out, stamped with the global time the host latched at the
// strobe.
#pragma once

#include <array>
#include <vector>

#include "nodes/camera/triangulation.h"
#include "nodes/laser/laser_preprocessor.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes {

// Ports: `raw` (layer, azimuth, range) -> `objects` (position, heading, extent and their uncertainty).
class LaserPreprocessing final : public Step {
 public:
  LaserPreprocessing(const schedules::Cluster& cluster, const schedules::Task& task,
                     const LaserPreprocessingConfig& config);
  void run(StepContext& context) override;

 private:
  SensorId sensor_;
  std::array<std::size_t, 3> raw_;
  std::array<std::size_t, 12> signals_;
  LaserPreprocessor preprocessor_;
  std::vector<ScanPoint> points_;
  std::vector<LaserObject> objects_;
};

// Ports: `raw` (bearing, disparity, width) -> `objects` (position and its covariance, span of the silhouette).
class CameraPreprocessing final : public Step {
 public:
  CameraPreprocessing(const schedules::Cluster& cluster, const schedules::Task& task,
                      const CameraCalibration& calibration);
  void run(StepContext& context) override;

 private:
  SensorId sensor_;
  std::array<std::size_t, 3> raw_;
  std::array<std::size_t, 7> signals_;
  CameraCalibration calibration_;
  std::vector<CameraObject> objects_;
};

// Ports: `in` -> `out`, the list unchanged: fragments of the CAN are fragments of the FlexRay.
class Gateway final : public Step {
 public:
  void run(StepContext& context) override;
};

}  // namespace ttf::nodes
