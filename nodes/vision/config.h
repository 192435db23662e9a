// The parameters of cameras that share a detector (docs/fusion/adaptive_detection.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "core/time.h"
#include "nodes/vision/frame_plan.h"
#include "nodes/vision/regions.h"
#include "sensors/mono_camera/ground_plane.h"

namespace ttf::nodes::vision {

// A region of interest that a scenario states instead of a planner.
struct FixedRegion {
  std::string camera;
  int line = 0;  // in the scenario
  Region region;
};

// A mode that a scenario names for the cameras that have a region.
struct ModeOfRegions {
  std::vector<std::string> cameras;
  std::string mode;
  int line = 0;  // in the scenario
};

struct AdaptiveCameraConfig {
  FramePlanConfig plan;
  Duration picture_time = Duration::microseconds(231'500);  // of a whole picture, on the machine where it was measured
  double hardware_factor = 0.2;                             // this machine's times over those of that one
  double deviation = 0.1;                                   // standard deviation of a time, as a share of it
  double smallest_region_px = 64.0;                         // a smaller region grows to this width and height
  Duration oldest_region = Duration::milliseconds(500);
  std::vector<FixedRegion> regions;
  std::vector<ModeOfRegions> modes;
};
AdaptiveCameraConfig load_adaptive_camera(YamlMap& yaml);
// Returns the mean time of a detection in a whole picture.
Duration whole_picture(const AdaptiveCameraConfig& config);

// A camera of the detector: its picture reaches this far from its middle.
struct SharedCamera {
  double half_width_px = 0.0, half_height_px = 0.0;
  sensors::mono_camera::MonoCalibration calibration;
};

// The key from which the times of detections are drawn.
struct DetectionKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
};

}  // namespace ttf::nodes::vision
