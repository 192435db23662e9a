// The feature service: reads the real-time image when its schedule says so and judges each object ahead.
#pragma once

#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/fusion/image_codec.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::service {

struct FeatureConfig {
  double own_speed_mps = 0.0;          // of the sensor car along x, over ground; it stands in the paper's drives
  double corridor_half_width_m = 1.8;  // objects farther off the line of travel do not warn: half a 3.6 m lane
  double warning_time_s = 2.7;  // time to collision below which it warns (ISO 15623 class forward collision warning)
  // How far the instant an image is predicted to may be from the instant of use. An image is predicted to its first
  // use; one that did not come is replaced by the one before, which is older by its period: two of 40 ms may be missed
  // in a row.
  Duration max_image_age = Duration::milliseconds(100);
};
FeatureConfig load_feature(YamlMap& yaml);

// What the image says is measured in the sensor car's frame, so its velocities are relative to the sensor car: the own
// speed is in them already. Clearance: distance along the line of sight to the outline, which is what is typical of
// vehicles where it was not measured (records.h).
//   time to collision  clearance / closing speed, the closing speed being - d(range)/dt, as ISO 15623 has it for
//                      constant speeds
//   time gap           clearance / own speed of what is ahead, as ISO 15622 has it: the time until the sensor car is
//                      where the object's near edge is now
// Infinite where the denominator is not positive (time to collision: not above what noise makes of zero).
recording::records::FeatureObject judge(const recording::records::ImageObject& object, const FeatureConfig& config);

// Port `image`. Where the newest image is older than max_image_age (its fusion node is dead, or starting anew and not
// yet believed, bus/cni/list_buffer.h L3), or that far from the future, it is refused: recorded as stale, its objects
// are not judged, and nothing is put in their place.
class FeatureService final : public host::Step {
 public:
  FeatureService(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                 const FeatureConfig& config);
  void run(host::StepContext& context) override;

 private:
  FeatureConfig config_;
  Duration round_;
  fusion::ImageSignals signals_;
  GlobalTime valid_at_{};  // of the newest image, told when it came: later, its wrapped stamp could mean another round
  std::vector<recording::records::FeatureObject> objects_;
};

}  // namespace ttf::nodes::service
