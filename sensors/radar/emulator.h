// A radar as a device.
#pragma once

#include <array>
#include <vector>

#include "sensors/emulator.h"
#include "sensors/radar/model.h"

namespace ttf::sensors::radar {

// Port `raw`: returns as range [m], azimuth [rad], range_rate [m/s], power [dB over the noise].
class RadarEmulator final : public Emulator {
 public:
  RadarEmulator(const EmulatorConfig& config, const RadarConfig& radar);
  void run(nodes::host::StepContext& context) override;

 private:
  RadarConfig radar_;
  std::array<std::size_t, 4> signals_;
  RadarRoom room_;
  std::vector<RadarReturn> returns_;
};

}  // namespace ttf::sensors::radar
