#include "sensors/radar/emulator.h"

namespace ttf::sensors::radar {

RadarEmulator::RadarEmulator(const EmulatorConfig& config, const RadarConfig& radar)
    : Emulator(config), radar_(in_drive(radar, config.drive())),
      signals_(nodes::host::bind_element<4>(*config.cluster, config.written("raw"),
                                            {"range", "azimuth", "range_rate", "power"})),
      room_(config.scene->objects()) {
  radar_.max_returns = config.written("raw").max_elements;
  returns_.reserve(static_cast<std::size_t>(radar_.max_returns));
}

void RadarEmulator::run(nodes::host::StepContext& context) {
  const TrueTime at = look(context, radar_.device);
  const AntennaVelocity antenna = antenna_velocity(config_.scene->ego_at(at), radar_.device.placement);
  measure_radar(radar_, states_, antenna, key(context), room_, returns_, truth_);
  write_list(context.outputs[0], context.measurement, GlobalTime{}, signals_, returns_, [](const RadarReturn& one) {
    return std::array{one.range, one.azimuth, one.range_rate, one.power_db};
  });
  record(context);
}

}  // namespace ttf::sensors::radar
