// The feature service: reads the real-time image when its schedule says so and judges each object ahead.
#pragma once

#include <vector>

#include "core/strict_yaml.h"
#include "nodes/image_codec.h"
#include "nodes/step.h"
#include "schedules/cluster.h"

namespace ttf::nodes {

struct FeatureConfig {
  double own_speed_mps = 0.0;          // of the sensor car along x, over ground; it stands in the paper's drives
  double corridor_half_width_m = 1.8;  // objects farther off the line of travel do not warn: half a 3.6 m lane
  double warning_time_s = 2.7;         // time to collision below which it warns (ISO 15623 class forward collision warning)
};
FeatureConfig load_feature(YamlMap& yaml);

// What the image says is measured in the sensor car's frame, so its velocities are relative to the sensor car: the own speed is in
// them already. Clearance: distance along the line of sight to the outline, which is what is typical of vehicles where it was
// not measured (records.h).
//   time to collision  clearance / closing speed, the closing speed being - d(range)/dt, as ISO 15623 has it for constant speeds
//   time gap           clearance / own speed of what is ahead, as ISO 15622 has it: the time until the sensor car is where the
//                      object's near edge is now
// Infinite where the denominator is not positive (time to collision: not above what noise makes of zero).
records::FeatureObject judge(const records::ImageObject& object, const FeatureConfig& config);

// Port `image`.
class FeatureService final : public Step {
 public:
  FeatureService(const schedules::Cluster& cluster, const schedules::Task& task, const FeatureConfig& config);
  void run(StepContext& context) override;

 private:
  FeatureConfig config_;
  ImageSignals signals_;
  std::vector<records::FeatureObject> objects_;
};

}  // namespace ttf::nodes
