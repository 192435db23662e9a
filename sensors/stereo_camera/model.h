// A stereo camera that lists vehicles by bearing, disparity and width.
//
// Rectified pinhole pair: a point at depth z has the disparity f b / z, so depth noise grows with the square of
// the depth. The defaults are of the class of the paper's stereo system (automotive baseline of some
// decimetres, sub-pixel matching). The camera sees the middle of an object's silhouette, at the mean depth of
// its visible outline. It misses an object whose middle is hidden by another (`shadow`), and other objects at
// random. False detections appear anywhere in the field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "sensors/device.h"
#include "sensors/occlusion.h"
#include "sim/world/weather.h"
#include "sim/world/world.h"

namespace ttf::sensors::stereo_camera {

struct CameraConfig {
  double baseline_m = 0.4;
  double focal_px = 1100.0;
  double disparity_sigma_px = 0.3;
  double bearing_sigma_rad = 0.003;
  double width_sigma_px = 2.0;
  double half_field_rad = 0.45;  // 26 degrees to either side
  double max_range_m = 90.0;
  double miss_probability = 0.05;
  // An object hides all behind it up to this share of its own distance: t / (h - t) for objects of height t,
  // seen from a mast of height h. A camera no higher than the objects, on a car, never sees over them.
  double shadow = std::numeric_limits<double>::infinity();
  double clutter_per_frame = 0.1;  // mean number of false detections
  DriveError bearing_bias;         // systematic errors, zero by default: [rad]
  DriveError disparity_bias;       // [px]
  Device device;
  int max_detections = 40;  // capacity of a raw list; the first ones are kept
};
CameraConfig load_camera(YamlMap& yaml);
// Returns the sensor in this weather.
CameraConfig in_weather(CameraConfig config, const sim::world::Weather& weather);
// Returns the configuration with the systematic errors of one drive.
CameraConfig in_drive(CameraConfig config, const DriveKey& key);

struct CameraDetection {
  double bearing = 0;    // [rad]
  double disparity = 0;  // [px]
  double width_px = 0;   // the silhouette's
};

// The matched part of an object: the middle of its silhouette, at the mean depth of the visible outline.
struct Seen {
  double bearing = 0.0;     // [rad]
  double depth = 0.0;       // [m], along the optical axis
  double silhouette = 0.0;  // [rad]
};

// Room for as many objects, so that measuring allocates nothing.
struct CameraRoom {
  explicit CameraRoom(std::size_t most_objects) : occlusion(most_objects), seen(most_objects), sights(most_objects) {}
  Occlusion occlusion;
  std::vector<Seen> seen;
  std::vector<Sight> sights;
};

// Replaces `detections` by those of `objects`, which are in the sensor's axes. `truth` has the object of each,
// 0xffff for a false one.
void measure_camera(const CameraConfig& config, std::span<const ObjectState> objects, const MeasurementKey& key,
                    CameraRoom& room, std::vector<CameraDetection>& detections, std::vector<ObjectId>& truth);

}  // namespace ttf::sensors::stereo_camera
