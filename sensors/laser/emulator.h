// A laser scanner as a device.
#pragma once

#include <array>
#include <vector>

#include "sensors/emulator.h"
#include "sensors/laser/model.h"

namespace ttf::sensors::laser {

// Port `raw`: hit points as layer, azimuth [rad], range [m].
class LaserEmulator final : public Emulator {
 public:
  LaserEmulator(const EmulatorConfig& config, const LaserConfig& laser);
  void run(nodes::host::StepContext& context) override;

 private:
  LaserConfig laser_;
  std::array<std::size_t, 3> signals_;
  std::vector<HitPoint> hits_;
};

}  // namespace ttf::sensors::laser
