// The own place along a straight line, by odometry alone: from the first sample on, speed and yaw rate are integrated.
//
// The line begins at the vehicle's place then, in its own direction. So a vehicle that starts along the middle of a
// straight lane has its place in that lane. Nothing corrects the place later. A constant error b of the yaw rate
// moves it aside by v b t^2 / 2. For 29 m/s and 0.002 rad/s this is 2.9 m after 10 s.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "fusion/ego/ego_path.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::driving {

// The middle of the rear axle: [m] along the line and to its left, [rad], [m/s], [rad/s].
struct PoseOnLine {
  double along = 0.0, offset = 0.0, heading = 0.0, speed = 0.0, yaw_rate = 0.0;
};

// Port `odometry`.
class OwnPlace {
 public:
  OwnPlace(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
  // Takes a new sample in; returns the place at the execution's start, and none without global time or once the
  // odometry has stopped (fusion/ego/odometry.h). Call it at each execution.
  std::optional<PoseOnLine> look(const host::StepContext& context);

 private:
  Duration round_;
  std::size_t odometry_ = 0;  // the port's place among the inputs
  std::array<std::size_t, 4> signals_;
  ttf::fusion::ego::EgoPath path_;
};

}  // namespace ttf::nodes::driving
