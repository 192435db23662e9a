// Outlines of a scene's parts: an object's rectangle, an estimate's ellipse, the edge of a sensor's field.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "recording/records/records.h"
#include "recording/scene/viewed.h"

namespace ttf::recording::scene {

// Checks that an object of a truth or an image has finite numbers; a damaged log may have others.
template <class Object> bool drawable(const Object& object) {
  return std::isfinite(object.x) && std::isfinite(object.y) && std::isfinite(object.heading) &&
         std::isfinite(object.length) && std::isfinite(object.width);
}
template <class Object> Pose place_of(const Object& object) { return {object.x, object.y, object.heading}; }

// The ellipse of so many standard deviations has 39 % (1), 86 % (2) or 99 % (3) of a Gaussian in the plane.
inline constexpr double kEllipseSigmas = 2.0;
inline constexpr int kEllipsePoints = 24;
// Returns the outline of an object's position as a Gaussian; empty if a damaged log has none.
std::vector<Point> ellipse(const records::ImageObject& object);

// Returns the corners of a rectangle with its centre at `place`, counter-clockwise from the front left.
std::array<Point, 4> rectangle(const Pose& place, double length, double width);

// Returns the edge of a field in the sensor's axes: an arc at its longest range, and back at its shortest.
std::vector<Point> edge(const ViewedField& field);
// Returns the place of an object `seconds` later, in the axes that the vehicle has then. The object drives straight along its
// heading with `speed`, over ground. With an `own` motion of zero, the speed is relative to the vehicle.
Pose moved_on(const Pose& place, double speed, const OwnMotion& own, double seconds);

// Returns whether two convex outlines overlap.
bool overlap(const std::array<Point, 4>& a, const std::array<Point, 4>& b);

// Returns the curvature [1/m] of a vehicle's way if it keeps its speed and yaw rate; 0 for a slow one.
double way_curvature(const records::EgoTruth& ego);
// Returns the gap [m] between a vehicle's front, `front_m` ahead of its origin, and an object that lies in its way,
// `width_m` wide; no value for an object that is behind the origin or beside the way. The object is in the vehicle's
// axes.
std::optional<double> gap_ahead(const records::TruthState& object, double front_m, double width_m, double curvature);

// Returns the points, given in the axes of `mounting`, in the vehicle's.
std::vector<Point> mounted(const Pose& mounting, std::vector<Point> points);

}  // namespace ttf::recording::scene
