// The feature service: reads the real-time image when its schedule says so and judges each object ahead.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/strict_yaml.h"
#include "nodes/step.h"
#include "schedules/cluster.h"

namespace ttf::nodes {

struct FeatureConfig {
  double own_speed_mps = 0.0;          // of the sensor car along x; it stands in the paper's drives
  double corridor_half_width_m = 1.8;  // objects farther off the line of travel do not warn: half a 3.6 m lane
  double warning_time_s = 2.7;         // time to collision below which it warns (ISO 15623 class forward collision warning)
};
FeatureConfig load_feature(YamlMap& yaml);

// Time gap: distance ahead / own speed. Time to collision: distance / closing speed along the line of sight. Both
// infinite where the denominator is not positive. The object is taken at its near edge, half its length before its
// centre.
records::FeatureObject judge(const records::ImageObject& object, const FeatureConfig& config);

// Port `image`.
class FeatureService final : public Step {
 public:
  FeatureService(const schedules::Cluster& cluster, const schedules::Task& task, const FeatureConfig& config);
  void run(StepContext& context) override;

 private:
  FeatureConfig config_;
  std::array<std::size_t, 17> signals_;
  std::vector<records::FeatureObject> objects_;
};

}  // namespace ttf::nodes
