#include "sensors/odometry/emulator.h"

namespace ttf::sensors::odometry {

OdometryEmulator::OdometryEmulator(const EmulatorConfig& config, const OdometryConfig& odometry)
    : Emulator(config), odometry_(in_drive(odometry, config.drive())),
      signals_(nodes::host::bind_element<2>(*config.cluster, config.written("raw"), {"speed", "yaw_rate"})) {}

void OdometryEmulator::run(nodes::host::StepContext& context) {
  const TrueTime at = measured_at(context.stamp.true_time, odometry_.device);
  const OdometrySample sample = measure_odometry(odometry_, config_.scene->ego_at(at), key(context));
  nodes::host::Output& raw = context.outputs[0];
  raw.begin(context.measurement, 1, GlobalTime{});
  raw.set(0, signals_[0], sample.speed);
  raw.set(0, signals_[1], sample.yaw_rate);
  record(context);
}

}  // namespace ttf::sensors::odometry
