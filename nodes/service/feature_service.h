// The feature service: reads the real-time image at the instants of its schedule, and judges each object ahead.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/fusion/image_codec.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::service {

struct FeatureConfig {
  // The sensor car's along x, over ground; zero in the paper's drives. It is for drives without odometry.
  double own_speed_mps = 0.0;
  double corridor_half_width_m = 1.8;  // objects farther off the line of travel cause no warning: half a 3.6 m lane
  double warning_time_s = 2.7;         // warns below this time to collision (ISO 15623 class forward collision warning)
  // The largest difference between an image's predicted instant and its use. An image is predicted to its first use.
  // A missing image is replaced by the previous one, which is one period older: at 40 ms, two in a row may be missing.
  Duration max_image_age = Duration::milliseconds(100);
};
FeatureConfig load_feature(YamlMap& yaml);

// Judges an object of the image. Without odometry the image is measured in the sensor car's frame, so its velocities are
// relative to the sensor car and include the own speed. With odometry they are over ground, along the car's axes. The
// measured speed then makes them relative; the car's turn changes no distance from it. The clearance is the distance along the line of sight
// to the outline; an unmeasured outline is a typical vehicle's (records.h).
//   time to collision  clearance / closing speed, the closing speed being - d(range)/dt, as in ISO 15623 for constant
//                      speeds
//   time gap           clearance / own speed for an object ahead, as in ISO 15622: the time until the sensor car is at
//                      the present place of the object's near edge
// Infinite if the denominator is not positive; for the time to collision, if it is not above its noise at zero.
recording::records::FeatureObject judge(const recording::records::ImageObject& object, const FeatureConfig& config,
                                        std::optional<double> measured_speed = std::nullopt);

// Ports `image` and, if it is bound, `odometry`. Until the first list of a bound odometry no object is judged; then the
// newest one counts. An image is stale if it is older than max_image_age, or that far in the future: its fusion node
// is dead, or has started anew and is not believed yet (bus/cni/list_buffer.h L3). A stale image is recorded as
// such; its objects are not judged, and nothing replaces them.
class FeatureService final : public host::Step {
 public:
  FeatureService(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                 const FeatureConfig& config);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view port) const override { return port == "odometry"; }

 private:
  FeatureConfig config_;
  Duration round_;
  std::size_t image_ = 0;                // the port's place among the inputs
  std::optional<std::size_t> odometry_;  // likewise, if it is bound
  std::size_t speed_ = 0;                // the signal
  fusion::ImageSignals signals_;
  GlobalTime valid_at_{};  // the newest image's, computed on arrival: later, its stamp could mean another round
  std::vector<recording::records::FeatureObject> objects_;
};

}  // namespace ttf::nodes::service
