// The times of a detector's recent detections, from which the next frame is planned.
//
// A primary detection is expected to take the mean of the sensor's last ones: ten, unless another number is stated.
// Before the first one it is expected to take a first guess. A secondary one is expected to take a share of the mean
// primary one: the mean area of the regions over that of a picture. A detection occupies the detector for whole steps,
// at least two. Its picture is taken at the first step's beginning, and its result is there at the end of the last one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/time.h"

namespace ttf::schedules::sequence {

class DetectionHistory {
 public:
  static constexpr std::size_t kKept = 10, kMostKept = 100;

  // Allocates all that it needs. `kept` is 1..kMostKept.
  DetectionHistory(int sensors, Duration first_guess, std::size_t kept = kKept);
  void add(int sensor, Duration primary);
  // Returns the expected time of a primary detection of this sensor, and the sum of all sensors' (P of generator.h).
  Duration primary(int sensor) const;
  Duration primaries() const;
  // Returns the expected time of a secondary detection in a region with this share of a picture's area, 0..1.
  Duration secondary(double share) const;

 private:
  struct Times {
    std::array<Duration, kMostKept> last{};
    std::size_t count = 0;  // all that were added
  };
  std::vector<Times> times_;
  Duration first_guess_;
  std::size_t kept_;
};

// Returns how long a detection occupies the detector: whole steps, at least two.
Duration occupied(Duration detection, Duration step);

}  // namespace ttf::schedules::sequence
