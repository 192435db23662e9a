// A rectangle through the returns of one object, and what it says about a vehicle's centre, heading and size.
//
// The orientation is searched for (Zhang, Xu, Dong, Dolan: "Efficient L-shape fitting for vehicle detection using laser
// scanners", IEEE Intelligent Vehicles Symposium 2017, closeness criterion, algorithm 4): each candidate scores how
// near the returns lie to the two faces turned to the sensor. A face is visible where the sensor stands outside its
// slab. The best one (orientation_search.h) is refined by least squares over both faces.
// Then:
//   - extents longer than a vehicle is wide are its length; a single short face is its rear or front, so the length is
//     unknown;
//   - the centre lies half the size behind each visible face; where the size is unknown the nominal one stands in, with
//     its spread, so that the covariance along that axis is honest.
#pragma once

#include <span>

#include "fusion/sensors/plane_position.h"
#include "nodes/laser/segmentation.h"

namespace ttf::nodes::laser {

struct RectangleConfig {
  double range_noise_m = 0.06;
  double azimuth_step_rad = 0.00436;
  // Passenger cars: mean and spread of length and width (European fleet, 3.6..5.0 m by 1.6..2.0 m).
  double nominal_length_m = 4.4, length_sigma_m = 0.35;
  double nominal_width_m = 1.8, width_sigma_m = 0.12;
  double widest_rear_m = 2.6;      // a longer extent is a side
  double narrowest_width_m = 1.3;  // a shorter face is only part of one
};

// Position of the vehicle's centre, heading [rad] of its long axis (up to half a turn), size [m]. Values whose has_
// flag is clear are nominal, their sigma the fleet's.
struct LaserObject : ttf::fusion::sensors::PlanePosition {
  double heading = 0, length = 0, width = 0;
  double sigma_heading = 0, sigma_length = 0, sigma_width = 0;
  bool has_heading = false, has_length = false, has_width = false;
  int points = 0;
};

// At least one point, in order of azimuth. The covariance is always positive definite.
LaserObject fit_rectangle(const RectangleConfig& config, std::span<const PlanePoint> points);

}  // namespace ttf::nodes::laser
