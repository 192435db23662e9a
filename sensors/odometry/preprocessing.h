// The host's preprocessing of odometry: a list of one element, how fast the sensors' vehicle drives and turns.
#pragma once

#include <array>

#include "core/strict_yaml.h"
#include "sensors/odometry/model.h"
#include "sensors/preprocessing.h"

namespace ttf::sensors::odometry {

// The noise that the host assumes; a sensor's systematic errors are not part of it.
struct OdometryPreprocessingConfig {
  double speed_sigma_mps = OdometryConfig{}.speed_sigma_mps;
  double yaw_rate_sigma_radps = OdometryConfig{}.yaw_rate_sigma_radps;
};
OdometryPreprocessingConfig load_odometry_preprocessing(YamlMap& yaml);

// Ports: `raw` (speed, yaw_rate) -> `odometry` (the same with their sigmas).
class OdometryPreprocessing final : public Preprocessing {
 public:
  OdometryPreprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                        const OdometryPreprocessingConfig& config);

 private:
  void process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) override;

  std::array<std::size_t, 2> raw_;
  std::array<std::size_t, 4> signals_;
  OdometryPreprocessingConfig config_;
};

}  // namespace ttf::sensors::odometry
