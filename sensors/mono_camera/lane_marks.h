// The marks of lanes as a camera measures them.
//
// A mark is a line beside the vehicle: its offset to the left of the vehicle's x axis at some distance ahead, and its heading
// and curvature there. A camera fits all three to the picture, each with noise. It misses marks, and takes other lines
// for marks: shadows, kerbs, joints. Those have a drawn offset, and lie nearly along the road.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "sensors/device.h"

namespace ttf::sensors::mono_camera {

struct LaneMark {
  double offset = 0.0;     // [m]
  double heading = 0.0;    // [rad], from the vehicle's x axis
  double curvature = 0.0;  // [1/m]
};

struct LaneMarkConfig {
  static constexpr std::size_t kMost = 16;  // marks with draws of their own; further ones are not seen
  double ahead_m = 10.0;                    // where marks are measured, from the vehicle's origin
  double widest_m = 7.0;                    // marks further aside are not seen
  double offset_sigma_m = 0.05;
  double heading_sigma_rad = 0.005;
  double curvature_sigma_per_m = 0.0005;
  double miss_probability = 0.05;
  double false_per_list = 0.02;  // mean number
};
LaneMarkConfig load_lane_marks(YamlMap& yaml);

// Replaces `seen` by the measured ones of `marks`, at most `capacity`. `truth` has the index of each mark, 0xffff for a
// false one. Draws are those of the sensor's list, apart from those of its other measurements.
void measure_lane_marks(const LaneMarkConfig& config, std::span<const LaneMark> marks, const MeasurementKey& key,
                        std::size_t capacity, std::vector<LaneMark>& seen, std::vector<std::uint16_t>& truth);

}  // namespace ttf::sensors::mono_camera
