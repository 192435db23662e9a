// Odometry: the speed of the rear axle's middle, from its wheels, and the yaw rate, from a gyroscope.
//
//   speed = (1 + scale) vx + noise,   yaw_rate = w + bias + noise.
// The scale errs with the tyres' radius, by up to 1 % between new and worn ones. It is constant through a drive. So is the
// gyroscope's bias. Noise is keyed by the number of the measurement. The default noises are assumed, of the class of production
// cars: wheels of some 48 teeth, and a gyroscope of 0.1 degree a second.
#pragma once

#include <cstdint>

#include "core/strict_yaml.h"
#include "sensors/device.h"
#include "sim/world/ego.h"

namespace ttf::sensors::odometry {

struct OdometryConfig {
  double speed_sigma_mps = 0.05;
  double yaw_rate_sigma_radps = 0.002;
  DriveError speed_scale;    // systematic errors, zero by default: a share of the speed
  DriveError yaw_rate_bias;  // [rad/s]
  Device device;             // its place does not matter
};
OdometryConfig load_odometry(YamlMap& yaml);
// Returns the configuration with the systematic errors of one drive.
OdometryConfig in_drive(OdometryConfig config, const DriveKey& key);

struct OdometrySample {
  double speed = 0.0;     // [m/s]
  double yaw_rate = 0.0;  // [rad/s]
};
OdometrySample measure_odometry(const OdometryConfig& config, const sim::world::EgoState& ego,
                                const MeasurementKey& key);

}  // namespace ttf::sensors::odometry
