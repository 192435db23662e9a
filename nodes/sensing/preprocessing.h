// Preprocessing: turns raw sensor data into observation lists, stamped with the global time that the host
// latched at the strobe.
#pragma once

#include <array>
#include <vector>

#include "nodes/camera/triangulation.h"
#include "nodes/host/step.h"
#include "nodes/laser/laser_preprocessor.h"
#include "nodes/radar/returns.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::sensing {

// Ports: `raw` (layer, azimuth, range) -> `objects` (the seen point, heading, extent and their uncertainty).
class LaserPreprocessing final : public host::Step {
 public:
  LaserPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                     const laser::LaserPreprocessingConfig& config);
  void run(host::StepContext& context) override;

 private:
  SensorId sensor_;
  std::array<std::size_t, 3> raw_;
  std::array<std::size_t, 12> signals_;
  laser::LaserPreprocessor preprocessor_;
  std::vector<laser::ScanPoint> points_;
  std::vector<laser::LaserObject> objects_;
};

// Ports: `raw` (bearing, disparity, width) -> `objects` (position and its covariance, span of the silhouette).
class CameraPreprocessing final : public host::Step {
 public:
  CameraPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                      const camera::CameraCalibration& calibration);
  void run(host::StepContext& context) override;

 private:
  SensorId sensor_;
  std::array<std::size_t, 3> raw_;
  std::array<std::size_t, 7> signals_;
  camera::CameraCalibration calibration_;
  std::vector<camera::CameraObject> objects_;
};

// Ports: `raw` (range, azimuth, range_rate, power) -> `objects` (range, bearing, range_rate, their uncertainty, returns).
class RadarPreprocessing final : public host::Step {
 public:
  RadarPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                     const radar::RadarPreprocessingConfig& config);
  void run(host::StepContext& context) override;

 private:
  SensorId sensor_;
  std::array<std::size_t, 4> raw_;
  std::array<std::size_t, 7> signals_;
  radar::ReturnJoiner joiner_;
  std::vector<radar::Return> returns_;
  std::vector<radar::RadarObject> objects_;
};

}  // namespace ttf::nodes::sensing
