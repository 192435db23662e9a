// Odometry as a sensor device.
#pragma once

#include <array>

#include "sensors/emulator.h"
#include "sensors/odometry/model.h"

namespace ttf::sensors::odometry {

// Port `raw`: speed [m/s] and yaw rate [rad/s].
class OdometryEmulator final : public Emulator {
 public:
  OdometryEmulator(const EmulatorConfig& config, const OdometryConfig& odometry);
  void run(nodes::host::StepContext& context) override;

 private:
  OdometryConfig odometry_;
  std::array<std::size_t, 2> signals_;
};

}  // namespace ttf::sensors::odometry
