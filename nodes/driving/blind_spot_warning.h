// Blind spot warning: an object is beside the vehicle or behind it in a neighbouring lane.
//
// The zones are those that are commonly cited from ISO 17387. They reach from the driver's eyes to 3 m behind the rear
// bumper, and from 0.5 m to 3 m off the vehicle's side. An object is in a zone if its extent overlaps it. Its motion
// does not matter.
#pragma once

#include <array>

#include "core/strict_yaml.h"
#include "nodes/fusion/image_codec.h"
#include "nodes/host/step.h"

namespace ttf::nodes::driving {

struct BlindSpotConfig {
  double ahead_m = 1.4;   // the driver's eyes, ahead of the rear axle
  double behind_m = 4.1;  // behind the rear axle: 3 m behind the rear bumper of a car whose overhang is 1.1 m
  double nearest_m = 0.5, furthest_m = 3.0;  // off the side
  double margin_m = 0.3;                     // a warning ends when the object is further outside than this
  Duration max_image_age = Duration::milliseconds(100);
  double width_m = 1.8;  // the vehicle's
};
// Reads all but the vehicle's width.
BlindSpotConfig load_blind_spot(YamlMap& yaml);

// Port `image`. It warns for each side by itself. Without an image that is fresh enough, or without global time,
// warnings stay as they are.
class BlindSpotWarning final : public host::Step {
 public:
  BlindSpotWarning(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                   const BlindSpotConfig& config);
  void run(host::StepContext& context) override;

 private:
  // `side` is 1 on the left, -1 on the right.
  TrackId found(const host::Input& image, double side, double margin) const;

  BlindSpotConfig config_;
  Duration round_;
  fusion::ImageSignals signals_;
  GlobalTime valid_at_{};     // the newest image's
  std::array<bool, 2> on_{};  // left, right
};

}  // namespace ttf::nodes::driving
