// Forward collision warning and emergency braking, by the time to collision for constant speeds (ISO 15623).
#pragma once

#include <array>
#include <string_view>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/driving/ahead.h"
#include "nodes/driving/command.h"
#include "nodes/host/step.h"

namespace ttf::nodes::driving {

struct EmergencyConfig {
  double warning_time_s = 2.7;
  double braking_time_s = 1.6;  // less than the warning's: a driver gets the difference
  double deceleration = 8.0;    // [m/s^2]
  // A track that images have had for less long begins nothing, if others were there before (known_tracks.h). Second
  // tracks of the car ahead last for two images.
  Duration known_for = Duration::milliseconds(100);
  PathConfig path;
};
// Reads all but the vehicle's front.
EmergencyConfig load_emergency(YamlMap& yaml);

// Ports `image` and `odometry` -> `command`, which is valid while the service brakes. It warns below the warning time,
// and brakes below the braking time. It goes on until the object ahead is no longer approached or is lost, or the
// vehicle stands. A vehicle that stands begins neither, nor does a new track. Without a view its command is invalid,
// and its warnings stay as they are. The actuator goes on with the last accepted command for a while
// (sim/world/vehicle/driven.h).
class EmergencyBraking final : public host::Step {
 public:
  EmergencyBraking(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
                   const EmergencyConfig& config);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view port) const override { return port == "odometry"; }

 private:
  void report(host::StepContext& context, recording::records::WarningKind service, bool on, TrackId track,
              double time_to_collision);

  EmergencyConfig config_;
  WayAhead way_;
  CommandOutput out_;
  std::array<bool, 2> on_{};  // by service
};

}  // namespace ttf::nodes::driving
