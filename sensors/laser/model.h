// A four-layer automotive laser scanner.
//
// The defaults are of the class of the paper's Ibeo ALASCA XT, by its maker's data sheet and by papers that
// used it: 12.5 Hz, four layers within 3.2 degrees, 0.25 degree azimuth steps ahead, single-shot range noise of
// some centimetres. The range for dark targets is far below the 200 m for bright ones. Rays are cast at the
// objects' outlines; the nearest outline is hit, so objects hide each other. Noise is keyed by the numbers of the
// measurement and of the beam: a beam's draws do not depend on the rest of the scan. So paradigms that see the
// scene a little earlier or later see the same noise.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/strict_yaml.h"
#include "sensors/device.h"
#include "sim/world/weather.h"
#include "sim/world/world.h"

namespace ttf::sensors::laser {

enum class AzimuthPhase : std::uint8_t { kFixed, kDrawn };

struct LaserConfig {
  static constexpr int kMostLayers = 4;  // layers with draws of their own
  int layers = kMostLayers;
  double azimuth_step_rad = 0.00436;  // 0.25 degrees
  // Beams lie at multiples of the step. Or each scan shifts all of them by one drawn part of it, evenly to either side: the
  // mirror turns free of the clock that the beams follow. Where they are fixed, the ends of a face that keeps its place
  // are off by the same part of a step in every scan.
  AzimuthPhase azimuth_phase = AzimuthPhase::kFixed;
  double half_field_rad = 1.05;  // 60 degrees to either side
  double range_sigma_m = 0.06;
  double max_range_m = 120.0;
  double miss_at_100m = 0.3;  // probability that a ray's echo is lost at 100 m; grows with the range squared
  DriveError range_bias;      // systematic errors, zero by default: [m]
  DriveError azimuth_bias;    // [rad]
  Device device;
  int max_hits = 1300;  // capacity of a raw list; the first ones are kept
};
LaserConfig load_laser(YamlMap& yaml);
// Returns the sensor in this weather.
LaserConfig in_weather(LaserConfig config, const sim::world::Weather& weather);
// Returns the configuration with the systematic errors of one drive.
LaserConfig in_drive(LaserConfig config, const DriveKey& key);

struct HitPoint {
  int layer = 0;
  double azimuth = 0;  // [rad]
  double range = 0;    // [m]
};

// Replaces `hits` by the scan of `objects`, which are in the sensor's axes, by azimuth, then layer. Replaces
// `truth` by the object of each hit.
void measure_laser(const LaserConfig& config, std::span<const ObjectState> objects, const MeasurementKey& key,
                   std::vector<HitPoint>& hits, std::vector<ObjectId>& truth);

}  // namespace ttf::sensors::laser
