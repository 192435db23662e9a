// A stereo camera that lists vehicles by bearing, disparity and width.
//
// Rectified pinhole pair: a point at depth z has the disparity f b / z, so depth noise grows with the square of the
// depth. Defaults are of the class of the paper's stereo system (automotive baseline of some decimetres, sub-pixel
// matching). What is seen of an object is the middle of its silhouette, at the mean depth of the outline that shows; an
// object whose middle is hidden by another (`shadow`) is missed, others are missed at random, and false detections
// appear anywhere in the field.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "sim/world/placement.h"
#include "sim/world/world.h"

namespace ttf::sim::world {

struct CameraConfig {
  double baseline_m = 0.4;
  double focal_px = 1100.0;
  double disparity_sigma_px = 0.3;
  double bearing_sigma_rad = 0.003;
  double width_sigma_px = 2.0;
  double half_field_rad = 0.45;  // 26 degrees to either side
  double max_range_m = 90.0;
  double miss_probability = 0.05;
  // An object hides what is behind it up to this share of its own distance: t / (h - t) for objects of height t, seen
  // from a mast of height h. A camera no higher than they are, on a car, never sees over them.
  double shadow = std::numeric_limits<double>::infinity();
  double clutter_per_frame = 0.1;  // mean number of false detections
  DriveError bearing_bias;         // systematic errors, none unless stated: [rad]
  DriveError disparity_bias;       // [px]
  Device device;
  int max_detections = 40;  // what one raw list carries; of more, the first are kept
};
CameraConfig load_camera(YamlMap& yaml);
// With the systematic errors of one drive.
CameraConfig in_drive(CameraConfig config, const DriveKey& key);

struct CameraDetection {
  double bearing = 0;    // [rad]
  double disparity = 0;  // [px]
  double width_px = 0;   // of the silhouette
};

// `objects`: in the sensor's axes. Replaces `detections`; `truth` has the object of each, 0xffff for a false one.
void measure_camera(const CameraConfig& config, std::span<const ObjectState> objects, std::uint64_t seed,
                    std::uint32_t replication, std::uint16_t sensor, std::uint32_t sequence,
                    std::vector<CameraDetection>& detections, std::vector<ObjectId>& truth);

}  // namespace ttf::sim::world
