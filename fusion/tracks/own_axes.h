// A track's view in the vehicle's own axes. Tracks live in the odometry frame if the vehicle moves (fusion/ego/ego_path.h).
//
// Positions are relative to the vehicle at its pose, and velocity and acceleration over ground, along its axes. With R and X
// the vehicle's rotation and place, p = R' (P - X), v = R' V, a = R' A. To the covariance come
//   the pose's uncertainty   a metre ahead moves p by (-1, 0); a radian moves p, v and a by a quarter turn to the right,
//   constant errors          a bias b of the yaw rate and a scale s of the speed move a standing object with the velocity
//                            b (-p_y, p_x) + s speed (1, 0). A track follows. So its position is right, and its velocity
//                            over ground has that error.
#pragma once

#include "fusion/ego/ego_path.h"
#include "fusion/tracks/view.h"

namespace ttf::fusion::tracks {

// Takes a view from the odometry frame to the axes of the vehicle in this state.
void to_own_axes(TrackView& view, const ego::EgoState& ego, const ego::OdometryErrors& errors);

}  // namespace ttf::fusion::tracks
