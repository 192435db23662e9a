// A camera with one lens, which lists boxes in its picture, each with a class.
//
// Pinhole of focal length f, at the height h over flat ground. Columns u count to the right and rows v downwards from the
// middle of the picture [px], which the known mounting has turned level. A point at depth x, at y to the left and z over
// ground, is at
//   u = -f y / x,  v = f tan(atan((h - z) / x) - pitch).
// `pitch` is what load and road add: positive if the camera looks down. Its effect on columns is neglected: at 0.05 rad
// it is 0.1 % of the column. Pitch is common to all boxes of a drive, so that ranges by the ground plane err together,
// by pitch x^2 / h.
//
// A box reaches from the left to the right end of the silhouette. Its bottom and top are those of the outline's nearest
// point. Each edge has noise of its own. An object is detected with the probability
//   p / (1 + exp(-(b - b_half) / s)),  b the height of its box [px],
// the logistic curve by which detectors fade out towards small boxes. It is looked for if the middle of its box lies in
// the picture and, where regions of interest are stated, in one of them. An object whose middle is hidden by another is
// missed, and so is one beside a blind side of the vehicle. False boxes stand on the ground anywhere in field and regions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "sensors/device.h"
#include "sensors/mono_camera/lane_marks.h"
#include "sensors/occlusion.h"
#include "sim/world/weather.h"
#include "sim/world/world.h"

namespace ttf::sensors::mono_camera {

// A rectangle of the picture [px]; an edge that is not stated lies outside.
struct PictureRegion {
  static constexpr double kOutside = std::numeric_limits<double>::infinity();
  double left = -kOutside, right = kOutside, top = -kOutside, bottom = kOutside;
  bool holds(double column, double row) const {
    return left <= column && column <= right && top <= row && row <= bottom;
  }
};

struct MonoCameraConfig {
  static constexpr std::size_t kMostRegions = 8;
  double height_m = 1.3;  // over ground, behind the windscreen
  double focal_px = 1100.0;
  double half_field_rad = 0.45;                      // 26 degrees to either side
  double half_height_px = 400.0;                     // rows of the picture above and below its middle
  double max_range_m = 70.0;                         // boxes of objects further away are left out
  double column_sigma_px = 1.0, row_sigma_px = 1.0;  // each edge's
  double detection_probability = 0.95;               // for large boxes
  double half_detected_px = 18.0, detection_slope_px = 4.0;
  double class_confusion = 0.02;   // probability of any other class
  double clutter_per_frame = 0.1;  // mean number of false boxes
  std::array<PictureRegion, kMostRegions> regions{};
  std::size_t region_count = 0;  // 0: all of the picture
  LaneMarkConfig marks;          // measured where the cluster has a list for them
  DriveError bearing_bias;       // systematic errors, zero by default: [rad]
  DriveError pitch;              // [rad]
  Device device;
  int max_boxes = 40;  // capacity of a raw list; the first ones are kept
};
MonoCameraConfig load_mono_camera(YamlMap& yaml);
// Returns the sensor in this weather.
MonoCameraConfig in_weather(MonoCameraConfig config, const sim::world::Weather& weather);
// Returns the configuration with the systematic errors of one drive.
MonoCameraConfig in_drive(MonoCameraConfig config, const DriveKey& key);
// Returns the half angle that holds all regions [rad].
double looked_at(const MonoCameraConfig& config);
// Returns the probability that a box of this height [px] is detected.
double probability_of_detection(const MonoCameraConfig& config, double height_px);

struct MonoBox {
  double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;  // [px]
  sim::world::traffic::ObjectClass seen_as = sim::world::traffic::ObjectClass::kCar;
};

// Room for as many objects, so that measuring allocates nothing.
struct MonoCameraRoom {
  explicit MonoCameraRoom(std::size_t most_objects)
      : occlusion(most_objects), boxes(most_objects), sights(most_objects) {}
  Occlusion occlusion;
  std::vector<MonoBox> boxes;
  std::vector<Sight> sights;
};

// Replaces `boxes` by those of `objects`, which are in the sensor's axes. `truth` has the object of each, 0xffff for a
// false one.
void measure_mono_camera(const MonoCameraConfig& config, std::span<const ObjectState> objects,
                         const MeasurementKey& key, MonoCameraRoom& room, std::vector<MonoBox>& boxes,
                         std::vector<ObjectId>& truth);

}  // namespace ttf::sensors::mono_camera
