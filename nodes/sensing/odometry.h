// Odometry as a sensor device, and its preprocessing: a list of one element, how fast the sensors' vehicle drives and turns.
#pragma once

#include <array>
#include <cstddef>

#include "core/strict_yaml.h"
#include "nodes/host/step.h"
#include "nodes/sensing/emulators.h"
#include "schedules/model/cluster.h"
#include "sim/world/odometry.h"

namespace ttf::nodes::sensing {

// Port `raw`: speed [m/s] and yaw rate [rad/s].
class OdometryEmulator final : public host::Step {
 public:
  OdometryEmulator(const EmulatorConfig& config, const sim::world::OdometryConfig& odometry);
  void run(host::StepContext& context) override;

 private:
  EmulatorConfig config_;
  sim::world::DriveKey key_;
  sim::world::OdometryConfig odometry_;
  std::array<std::size_t, 2> signals_;
};

// The noise that the host assumes; a sensor's systematic errors are not part of it.
struct OdometryPreprocessingConfig {
  double speed_sigma_mps = sim::world::OdometryConfig{}.speed_sigma_mps;
  double yaw_rate_sigma_radps = sim::world::OdometryConfig{}.yaw_rate_sigma_radps;
};
OdometryPreprocessingConfig load_odometry_preprocessing(YamlMap& yaml);

// Ports: `raw` (speed, yaw_rate) -> `odometry` (the same with their sigmas).
class OdometryPreprocessing final : public host::Step {
 public:
  OdometryPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                        const OdometryPreprocessingConfig& config);
  void run(host::StepContext& context) override;

 private:
  SensorId sensor_;
  std::array<std::size_t, 2> raw_;
  std::array<std::size_t, 4> signals_;
  OdometryPreprocessingConfig config_;
};

}  // namespace ttf::nodes::sensing
