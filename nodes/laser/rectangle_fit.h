// Fits a rectangle to the returns of one object, and derives a vehicle's centre, heading and size.
//
// The orientation search (Zhang, Xu, Dong, Dolan: "Efficient L-shape fitting for vehicle detection using laser
// scanners", IEEE Intelligent Vehicles Symposium 2017, closeness criterion, algorithm 4) scores each candidate
// by the distances of the returns to the two faces turned to the sensor. A face is visible if the sensor stands
// outside its slab. Least squares over both faces refine the best candidate (orientation_search.h).
//
// Then:
//   - An extent longer than a vehicle is wide is its length. A single short face is the rear or the front: the length
//     is then unknown.
//   - The centre lies half the size behind each visible face. An unknown size is replaced by the nominal one with its
//     spread, which keeps the covariance along that axis honest.
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
  double narrowest_width_m = 1.3;  // a shorter face is only part of a width
};

// Position of the vehicle's centre, heading [rad] of its long axis (up to half a turn), size [m]. A value whose
// has_ flag is clear is nominal, and its sigma the fleet's.
struct LaserObject : ttf::fusion::sensors::PlanePosition {
  double heading = 0, length = 0, width = 0;
  double sigma_heading = 0, sigma_length = 0, sigma_width = 0;
  bool has_heading = false, has_length = false, has_width = false;
  int points = 0;
};

// Fits the rectangle. Expects at least one point, in order of azimuth. The covariance is always positive definite.
LaserObject fit_rectangle(const RectangleConfig& config, std::span<const PlanePoint> points);

}  // namespace ttf::nodes::laser
