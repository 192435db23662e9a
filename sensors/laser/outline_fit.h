// Fits the outline of one object to its returns, by maximum likelihood: a single straight face, or a convex corner of
// two faces at a right angle.
//
// A beam's direction is exact. Its range has independent Gaussian noise. The beam at direction u meets a face with inward
// normal n and distance d from the sensor at the range r = d / (n . u). At a corner the larger range of both faces counts.
// Gauss-Newton iteration minimises the squares of range errors. The inverse of its normal matrix is the covariance. So it
// contains the errors of the orientation, with their lever.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

#include "sensors/laser/segmentation.h"

namespace ttf::sensors::laser {

// A line at `distance` > 0 [m] from the sensor; its normal, away from the sensor, has the direction `normal` [rad].
struct FaceFit {
  double distance = 0.0, normal = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // (distance, normal)
  double squares = 0.0;                                  // squared range errors that are left, summed [m^2]
};

// Where two faces meet. The right one (smaller azimuths) has the normal `normal`, away from the sensor; the left
// one's is a quarter turn less.
struct CornerFit {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
  double normal = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // (corner x, corner y, normal)
  double squares = 0.0;                                  // at the best place of the corner
  double variance = 0.0;                                 // the ranges are taken to have this one [m^2]
};

// Both expect the returns of one segment, by azimuth, and the standard deviation of a range, `noise` [m]. If the fit
// leaves certainly more, this counts instead. Empty if no such outline is turned to the sensor, if the returns do not
// determine it, or if the iteration does not converge.
std::optional<FaceFit> fit_face(std::span<const PlanePoint> points, double noise);

// A corner may lie between any two beams around the likeliest ones: in one of these gaps its errors are Gaussian, cut
// to the gap's bearings. Beside them, it may lie beyond the last beam to either side, up to one `step` [rad], if
// `face` is the fit of all returns as one face. The result has the moments of this mixture.
std::optional<CornerFit> fit_corner(std::span<const PlanePoint> points, double noise, double step,
                                    const std::optional<FaceFit>& face);

}  // namespace ttf::sensors::laser
