// A service's view of its own lane: the line of its middle, from lists of lane marks and odometry.
//
// In the vehicle's axes the line is y(x) = offset + heading x + curvature x^2 / 2. A list's marks are measured `ahead`
// of the vehicle, at the list's instant. Odometry moves the view on to there. Then it takes a share kGain of the
// difference. So a wrong mark moves it a little, and a missing one not at all. Angles are small: at a quarter radian
// the line errs by 1 %.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/time.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::driving::steering {

struct LaneLine {
  double offset = 0.0;     // [m], to the left
  double heading = 0.0;    // [rad], from the vehicle's x axis
  double curvature = 0.0;  // [1/m]
};
// Returns the line as seen from `x` ahead on the vehicle's axis.
LaneLine seen_from(const LaneLine& line, double x);
// Returns the line as the vehicle sees it `seconds` later, at this speed [m/s] and yaw rate [rad/s].
LaneLine after(const LaneLine& line, double speed, double yaw_rate, double seconds);

struct LaneConfig {
  double ahead_m = 10.0;        // where the camera measures marks, from the vehicle's origin
  double width_m = 3.5;         // assumed until both marks are seen
  double least_validity = 0.6;  // less valid marks are not used
  // Beyond this age of the newest marks that were used there is no view: five lists of the mono camera.
  Duration max_marks_age = Duration::milliseconds(200);
  // As that of other services (ahead.h).
  Duration max_odometry_age = Duration::milliseconds(200);
};

struct Lane {
  LaneLine middle;                     // now, from the vehicle's origin
  double width = 0.0;                  // [m]
  double speed = 0.0, yaw_rate = 0.0;  // [m/s], [rad/s], by odometry
};

// Ports `marks` and `odometry`.
class OwnLane {
 public:
  static constexpr double kGain = 0.3;

  OwnLane(const schedules::model::Cluster& cluster, const schedules::model::Task& task, const LaneConfig& config);
  // Returns nothing without odometry and marks that are fresh enough, or without global time. Call it at each
  // execution.
  std::optional<Lane> look(const host::StepContext& context);

 private:
  std::optional<LaneLine> matched(const host::Input& marks, const std::optional<LaneLine>& expected);

  LaneConfig config_;
  Duration round_;
  std::size_t marks_ = 0, odometry_ = 0;  // the ports' places among the inputs
  std::array<std::size_t, 7> mark_signals_;
  std::array<std::size_t, 4> motion_signals_;
  GlobalTime measured_at_{};      // the newest list's of odometry
  std::optional<LaneLine> line_;  // at the instant of the newest marks that were used
  GlobalTime seen_at_{};          // that instant
  double width_;
};

}  // namespace ttf::nodes::driving::steering
