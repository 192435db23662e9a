#include "nodes/sensing/odometry.h"

#include "nodes/host/signals.h"

namespace ttf::nodes::sensing {

OdometryEmulator::OdometryEmulator(const EmulatorConfig& config, const sim::world::OdometryConfig& odometry)
    : config_(config), key_{config.seed, config.replication, static_cast<std::uint16_t>(config.sensor)},
      odometry_(sim::world::in_drive(odometry, key_)),
      signals_(host::bind_element<2>(*config.cluster,
                                     config.cluster->pdu(host::binding_of(config.task->writes, "raw").pdu),
                                     {"speed", "yaw_rate"})) {}

void OdometryEmulator::run(host::StepContext& context) {
  const TrueTime at = sim::world::measured_at(context.stamp.true_time, odometry_.device);
  const sim::world::OdometrySample sample =
      sim::world::measure_odometry(odometry_, config_.scene->ego_at(at), key_, context.measurement);
  host::Output& raw = context.outputs[0];
  raw.begin(context.measurement, 1, GlobalTime{});
  raw.set(0, signals_[0], sample.speed);
  raw.set(0, signals_[1], sample.yaw_rate);
  recording::records::Measured measured;
  measured.stamp = context.stamp;
  measured.id = {config_.sensor, context.measurement};
  context.sink->on(measured);
}

OdometryPreprocessingConfig load_odometry_preprocessing(YamlMap& yaml) {
  OdometryPreprocessingConfig c;
  c.speed_sigma_mps = yaml.number_or("speed_sigma", c.speed_sigma_mps, {0.0001, 5.0}, "m/s");
  c.yaw_rate_sigma_radps = yaml.number_or("yaw_rate_sigma", c.yaw_rate_sigma_radps, {1e-6, 1.0}, "rad/s");
  return c;
}

OdometryPreprocessing::OdometryPreprocessing(const schedules::model::Cluster& cluster,
                                             const schedules::model::Task& task,
                                             const OdometryPreprocessingConfig& config)
    : sensor_(cluster.pdu(host::binding_of(task.reads, "raw").pdu).sensor),
      raw_(host::bind_element<2>(cluster, cluster.pdu(host::binding_of(task.reads, "raw").pdu), {"speed", "yaw_rate"})),
      signals_(host::bind_element<4>(cluster, cluster.pdu(host::binding_of(task.writes, "odometry").pdu),
                                     {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"})),
      config_(config) {}

void OdometryPreprocessing::run(host::StepContext& context) {
  const auto measurement = measurement_of(context, sensor_);
  if (!measurement) return;
  const host::Input& raw = context.inputs[0];
  const int count = host::element_count(*raw.layout, *raw.list) > 0 ? 1 : 0;
  host::Output& out = context.outputs[0];
  out.begin(measurement->sequence, count, measurement->at);
  if (count == 0) return;
  for (std::size_t s = 0; s < raw_.size(); ++s)
    out.set(0, signals_[s], host::element_value(*raw.layout, *raw.list, 0, raw_[s]));
  out.set_at_least(0, signals_[2], config_.speed_sigma_mps);
  out.set_at_least(0, signals_[3], config_.yaw_rate_sigma_radps);
}

}  // namespace ttf::nodes::sensing
