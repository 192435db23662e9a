// Sequences of detections: which picture a detector looks at next.
//
// A vehicle has several cameras and one detector. A primary detection takes the whole picture of a sensor, a secondary one the
// region of interest alone. A frame is one sequence in which each sensor has its primary detection once. The next frame follows at
// once. Letters name both kinds: `AaBb` are two sensors, each with a primary and then a secondary detection.
//
// Terms and examples: Wolfe, "Adaptive object detection for autonomous vehicles" (Northern Illinois University, 2020), chapter 2.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"

namespace ttf::schedules::sequence {

struct Detection {
  int sensor = 0;
  bool secondary = false;

  auto operator<=>(const Detection&) const = default;
};
using Sequence = std::vector<Detection>;

inline constexpr int kMostSensors = 26;

// Returns one letter for each detection, capital for a primary one. `names` has a capital letter for each sensor.
std::string letters(const Sequence& sequence, std::string_view names = "ABCDEFGHIJKLMNOPQRSTUVWXYZ");

// The durations of detections, by sensor.
struct DetectionTimes {
  std::vector<Duration> primary, secondary;

  // The same for all sensors.
  DetectionTimes(int sensors, Duration of_primary, Duration of_secondary);
  Duration of(const Detection& detection) const;
};
// Returns the sum of the detections' durations.
Duration frame_time(const Sequence& sequence, const DetectionTimes& times);

}  // namespace ttf::schedules::sequence
