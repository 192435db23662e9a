#include "sensors/emulator.h"

namespace ttf::sensors {

Emulator::Emulator(const EmulatorConfig& config) : config_(config) {
  states_.reserve(config.scene->objects());
  truth_.reserve(static_cast<std::size_t>(config.written("raw").max_elements));
}

TrueTime Emulator::look(const nodes::host::StepContext& context, const Device& device) {
  const TrueTime at = measured_at(context.stamp.true_time, device);
  config_.scene->states_at(at, states_);
  see_from(device.placement, states_);
  return at;
}

MeasurementKey Emulator::key(const nodes::host::StepContext& context) const {
  return {config_.seed, config_.replication, static_cast<std::uint16_t>(config_.sensor), context.measurement};
}

void Emulator::record(const nodes::host::StepContext& context) const {
  recording::records::Measured measured;
  measured.stamp = context.stamp;
  measured.id = {config_.sensor, context.measurement};
  measured.truth_ids = truth_;
  context.sink->on(measured);
}

}  // namespace ttf::sensors
