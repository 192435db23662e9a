#include "sensors/odometry/preprocessing.h"

namespace ttf::sensors::odometry {

OdometryPreprocessingConfig load_odometry_preprocessing(YamlMap& yaml) {
  OdometryPreprocessingConfig c;
  c.speed_sigma_mps = yaml.number_or("speed_sigma", c.speed_sigma_mps, {0.0001, 5.0}, "m/s");
  c.yaw_rate_sigma_radps = yaml.number_or("yaw_rate_sigma", c.yaw_rate_sigma_radps, {1e-6, 1.0}, "rad/s");
  return c;
}

OdometryPreprocessing::OdometryPreprocessing(const schedules::model::Cluster& cluster,
                                             const schedules::model::Task& task,
                                             const OdometryPreprocessingConfig& config)
    : Preprocessing(cluster, task),
      raw_(nodes::host::bind_element<2>(cluster, layout_read(cluster, task, "raw"), {"speed", "yaw_rate"})),
      signals_(nodes::host::bind_element<4>(cluster, layout_written(cluster, task, "odometry"),
                                            {"speed", "yaw_rate", "sigma_speed", "sigma_yaw_rate"})),
      config_(config) {}

void OdometryPreprocessing::process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) {
  const nodes::host::Input& raw = context.inputs[0];
  const int count = nodes::host::element_count(*raw.layout, *raw.list) > 0 ? 1 : 0;
  nodes::host::Output& out = context.outputs[0];
  out.begin(measurement.sequence, count, measurement.at);
  if (count == 0) return;
  for (std::size_t s = 0; s < raw_.size(); ++s)
    out.set(0, signals_[s], nodes::host::element_value(*raw.layout, *raw.list, 0, raw_[s]));
  out.set_at_least(0, signals_[2], config_.speed_sigma_mps);
  out.set_at_least(0, signals_[3], config_.yaw_rate_sigma_radps);
}

}  // namespace ttf::sensors::odometry
