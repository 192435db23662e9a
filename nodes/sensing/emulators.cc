#include "nodes/sensing/emulators.h"

#include <algorithm>

#include "nodes/host/signals.h"

namespace ttf::nodes::sensing {
namespace {

const schedules::model::PduLayout& raw_layout(const EmulatorConfig& config) {
  return config.cluster->pdu(host::binding_of(config.task->writes, "raw").pdu);
}

std::size_t most_elements(const EmulatorConfig& config) {
  return static_cast<std::size_t>(raw_layout(config).max_elements);
}

sim::world::DriveKey drive_key(const EmulatorConfig& config) {
  return {config.seed, config.replication, static_cast<std::uint16_t>(config.sensor)};
}

void record_measurement(const host::StepContext& context, SensorId sensor, std::span<const ObjectId> truth) {
  recording::records::Measured measured;
  measured.stamp = context.stamp;
  measured.id = {sensor, context.measurement};
  measured.truth_ids = truth;
  context.sink->on(measured);
}

}  // namespace

LaserEmulator::LaserEmulator(const EmulatorConfig& config, const sim::world::LaserConfig& laser)
    : config_(config), laser_(sim::world::in_drive(laser, drive_key(config))),
      signals_(host::bind_element<3>(*config.cluster, raw_layout(config), {"layer", "azimuth", "range"})) {
  laser_.max_hits = raw_layout(config).max_elements;
  states_.reserve(config.scene->objects());
  hits_.reserve(most_elements(config));
  truth_.reserve(most_elements(config));
}

void LaserEmulator::run(host::StepContext& context) {
  config_.scene->states_at(sim::world::measured_at(context.stamp.true_time, laser_.device), states_);
  sim::world::see_from(laser_.device.placement, states_);
  sim::world::measure_laser(laser_, states_, config_.seed, config_.replication,
                            static_cast<std::uint16_t>(config_.sensor), context.measurement, hits_, truth_);
  host::Output& raw = context.outputs[0];
  const auto count = static_cast<int>(hits_.size());
  raw.begin(context.measurement, count, GlobalTime{});
  for (int i = 0; i < count; ++i) {
    const sim::world::HitPoint& hit = hits_[static_cast<std::size_t>(i)];
    raw.set(i, signals_[0], hit.layer);
    raw.set(i, signals_[1], hit.azimuth);
    raw.set(i, signals_[2], hit.range);
  }
  record_measurement(context, config_.sensor, truth_);
}

CameraEmulator::CameraEmulator(const EmulatorConfig& config, const sim::world::CameraConfig& camera)
    : config_(config), camera_(sim::world::in_drive(camera, drive_key(config))),
      signals_(host::bind_element<3>(*config.cluster, raw_layout(config), {"bearing", "disparity", "width"})),
      room_(config.scene->objects()) {
  camera_.max_detections = raw_layout(config).max_elements;
  states_.reserve(config.scene->objects());
  detections_.reserve(most_elements(config));
  truth_.reserve(most_elements(config));
}

void CameraEmulator::run(host::StepContext& context) {
  config_.scene->states_at(sim::world::measured_at(context.stamp.true_time, camera_.device), states_);
  sim::world::see_from(camera_.device.placement, states_);
  sim::world::measure_camera(camera_, states_, config_.seed, config_.replication,
                             static_cast<std::uint16_t>(config_.sensor), context.measurement, room_, detections_,
                             truth_);
  host::Output& raw = context.outputs[0];
  const auto count = static_cast<int>(detections_.size());
  raw.begin(context.measurement, count, GlobalTime{});
  for (int i = 0; i < count; ++i) {
    const sim::world::CameraDetection& detection = detections_[static_cast<std::size_t>(i)];
    raw.set(i, signals_[0], detection.bearing);
    raw.set(i, signals_[1], detection.disparity);
    raw.set(i, signals_[2], detection.width_px);
  }
  record_measurement(context, config_.sensor, truth_);
}

RadarEmulator::RadarEmulator(const EmulatorConfig& config, const sim::world::RadarConfig& radar)
    : config_(config), radar_(sim::world::in_drive(radar, drive_key(config))),
      signals_(host::bind_element<4>(*config.cluster, raw_layout(config), {"range", "azimuth", "range_rate", "power"})),
      room_(config.scene->objects()) {
  radar_.max_returns = raw_layout(config).max_elements;
  states_.reserve(config.scene->objects());
  returns_.reserve(most_elements(config));
  truth_.reserve(most_elements(config));
}

void RadarEmulator::run(host::StepContext& context) {
  const TrueTime at = sim::world::measured_at(context.stamp.true_time, radar_.device);
  config_.scene->states_at(at, states_);
  sim::world::see_from(radar_.device.placement, states_);
  const sim::world::AntennaVelocity antenna =
      sim::world::antenna_velocity(config_.scene->ego_at(at), radar_.device.placement);
  sim::world::measure_radar(radar_, states_, antenna, config_.seed, config_.replication,
                            static_cast<std::uint16_t>(config_.sensor), context.measurement, room_, returns_, truth_);
  host::Output& raw = context.outputs[0];
  const auto count = static_cast<int>(returns_.size());
  raw.begin(context.measurement, count, GlobalTime{});
  for (int i = 0; i < count; ++i) {
    const sim::world::RadarReturn& one = returns_[static_cast<std::size_t>(i)];
    raw.set(i, signals_[0], one.range);
    raw.set(i, signals_[1], one.azimuth);
    raw.set(i, signals_[2], one.range_rate);
    raw.set(i, signals_[3], one.power_db);
  }
  record_measurement(context, config_.sensor, truth_);
}

}  // namespace ttf::nodes::sensing
