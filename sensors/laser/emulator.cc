#include "sensors/laser/emulator.h"

namespace ttf::sensors::laser {

LaserEmulator::LaserEmulator(const EmulatorConfig& config, const LaserConfig& laser)
    : Emulator(config), laser_(in_drive(laser, config.drive())),
      signals_(nodes::host::bind_element<3>(*config.cluster, config.written("raw"), {"layer", "azimuth", "range"})) {
  laser_.max_hits = config.written("raw").max_elements;
  hits_.reserve(static_cast<std::size_t>(laser_.max_hits));
}

void LaserEmulator::run(nodes::host::StepContext& context) {
  look(context, laser_.device);
  measure_laser(laser_, states_, key(context), hits_, truth_);
  write_list(context.outputs[0], context.measurement, GlobalTime{}, signals_, hits_, [](const HitPoint& hit) {
    return std::array{static_cast<double>(hit.layer), hit.azimuth, hit.range};
  });
  record(context);
}

}  // namespace ttf::sensors::laser
