// The Kalman filter of one object: Cartesian state, linear motion, linear and linearised measurements.
//
// State (x, y, vx, vy, ax, ay) in metres and seconds, ISO 8855 axes; under constant velocity the
// accelerations are zero and certain. Prediction x <- F x, P <- F P F' + Q with the exactly discretised
// white-noise model (Bar-Shalom, Li, Kirubarajan: "Estimation with Applications to Tracking and Navigation",
// 2001, eq. 6.2.2-8 and 6.2.3-7). Update with gain K = P H' S^-1 by an LDLT solve, covariance in Joseph form
// (5.2.3-18), so P stays symmetric and positive.
#pragma once

#include <Eigen/Core>

#include "fusion/observation.h"
#include "fusion/tracker_config.h"

namespace ttf::fusion {

using State = Eigen::Matrix<double, 6, 1>;
using Covariance = Eigen::Matrix<double, 6, 6>;

struct Estimate {
  State x = State::Zero();
  Covariance p = Covariance::Zero();
};

// By dt >= 0 seconds.
void predict(Estimate& estimate, MotionModel motion, double process_noise, double dt);

// Innovation of an observation, the bearing's wrapped to (-pi, pi]. `valid` is false where the measurement
// model has no derivative (an object at the sensor's origin): such an observation cannot be used.
struct Innovation {
  Eigen::Vector3d nu = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 6> h = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  double distance_squared = 0.0;  // nu' S^-1 nu
  int dimension = 0;
  bool valid = false;
};
Innovation innovate(const Estimate& estimate, const Observation& observation);

// The update with that innovation.
void update(Estimate& estimate, const Observation& observation, const Innovation& innovation);

// Expected measurement and its Jacobian d h / d x at a state (range above zero for radar).
Eigen::Vector3d expected(ObservationKind kind, const State& x);
Eigen::Matrix<double, 3, 6> jacobian(ObservationKind kind, const State& x);

// A new estimate from one observation: its position, velocity unknown but for what a radar's range rate says.
Estimate initial_estimate(const Observation& observation, const TrackerConfig& config);

// To (-pi, pi].
double wrap_angle(double angle);

}  // namespace ttf::fusion
