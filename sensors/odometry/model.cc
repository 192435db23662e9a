#include "sensors/odometry/model.h"

#include "core/random.h"

namespace ttf::sensors::odometry {

OdometryConfig load_odometry(YamlMap& yaml) {
  OdometryConfig c;
  c.speed_sigma_mps = yaml.number_or("speed_sigma", c.speed_sigma_mps, {0.0, 5.0}, "m/s");
  c.yaw_rate_sigma_radps = yaml.number_or("yaw_rate_sigma", c.yaw_rate_sigma_radps, {0.0, 1.0}, "rad/s");
  c.speed_scale.fixed = yaml.number_or("speed_scale", 0.0, {-0.2, 0.2});
  c.speed_scale.sigma = yaml.number_or("speed_scale_sigma", 0.0, {0.0, 0.2});
  c.yaw_rate_bias.fixed = yaml.number_or("yaw_rate_bias", 0.0, {-0.5, 0.5}, "rad/s");
  c.yaw_rate_bias.sigma = yaml.number_or("yaw_rate_bias_sigma", 0.0, {0.0, 0.5}, "rad/s");
  c.device.time = load_time_error(yaml);
  return c;
}

OdometryConfig in_drive(OdometryConfig config, const DriveKey& key) {
  config.speed_scale = in_drive(config.speed_scale, ErrorOf::kSpeedScale, key);
  config.yaw_rate_bias = in_drive(config.yaw_rate_bias, ErrorOf::kYawRate, key);
  config.device.time = in_drive(config.device.time, ErrorOf::kTime, key);
  return config;
}

OdometrySample measure_odometry(const OdometryConfig& config, const sim::world::EgoState& ego,
                                const MeasurementKey& key) {
  RandomStream noise(key.of(Purpose::kSensorNoise));
  const double speed = noise.normal(), yaw_rate = noise.normal();
  return {(1.0 + config.speed_scale.fixed) * ego.vx + config.speed_sigma_mps * speed,
          ego.yaw_rate + config.yaw_rate_bias.fixed + config.yaw_rate_sigma_radps * yaw_rate};
}

}  // namespace ttf::sensors::odometry
