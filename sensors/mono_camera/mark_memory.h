// Separates lasting lane marks from those that a single picture shows.
//
// A mark is the same as one of the list before if offset and heading have hardly changed. Its validity is the number of lists in
// a row that show it, at most kLists, over kLists. A false one seldom comes again at its place.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/strict_yaml.h"

namespace ttf::sensors::mono_camera {

// The standard deviations that a host assumes of marks.
struct MarkCalibration {
  double offset_sigma_m = 0.05;
  double heading_sigma_rad = 0.005;
  double curvature_sigma_per_m = 0.0005;
};
MarkCalibration load_mark_calibration(YamlMap& yaml);

struct SeenMark {
  double offset = 0.0, heading = 0.0, curvature = 0.0;  // [m], [rad], [1/m]
  double validity = 0.0;                                // 0..1
};

class MarkMemory {
 public:
  static constexpr int kLists = 5;
  static constexpr double kOffset_m = 0.5, kHeading_rad = 0.05;  // changes from list to list

  // Allocates for that many marks.
  explicit MarkMemory(std::size_t most_marks);
  // Sets the validity of a list's marks, and remembers them.
  void judge(std::span<SeenMark> marks);

 private:
  std::vector<SeenMark> before_, now_;
};

}  // namespace ttf::sensors::mono_camera
