#include "fusion/tracks/own_axes.h"

#include <cmath>

#include "fusion/motion/angles.h"
#include "fusion/motion/kernels.h"

namespace ttf::fusion::tracks {

void to_own_axes(TrackView& view, const ego::EgoState& ego, const ego::OdometryErrors& errors) {
  const double c = std::cos(ego.vehicle.yaw), s = std::sin(ego.vehicle.yaw);
  linear::Matrix<6> back = linear::Matrix<6>::Zero();
  for (int i = 0; i < 6; i += 2) back.block<2, 2>(i, i) << c, s, -s, c;
  view.state.head<2>() -= ego.vehicle.position;
  view.state = (back * view.state).eval();
  view.covariance = motion::sandwich<6, 6>(back, view.covariance);

  linear::Vector<6> by_turn;
  for (int i = 0; i < 6; i += 2) by_turn.segment<2>(i) << view.state(i + 1), -view.state(i);
  by_turn(1) -= ego.behind;
  view.covariance(0, 0) += ego.along_variance;
  motion::add_outer<6>(view.covariance, ego.turn_variance, by_turn);
  const double scale = errors.speed_scale_sigma * ego.vehicle.velocity.norm(), bias = errors.yaw_rate_bias_sigma;
  view.covariance(2, 2) += scale * scale;
  const linear::Vector<2> swing(-view.state(1), view.state(0));
  view.covariance.block<2, 2>(2, 2) += bias * bias * swing * swing.transpose();

  view.heading = motion::to_half_turn(view.heading - ego.vehicle.yaw);
  view.sigma_heading = std::sqrt(view.sigma_heading * view.sigma_heading + ego.turn_variance);
  const linear::Vector<2> velocity = view.state.segment<2>(2);
  const linear::Vector<2> along =
      view.speed > 1e-9 ? linear::Vector<2>(velocity / view.speed) : linear::Vector<2>::UnitX();
  view.sigma_speed = std::sqrt(along.dot(view.covariance.block<2, 2>(2, 2) * along));
}

}  // namespace ttf::fusion::tracks
