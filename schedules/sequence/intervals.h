// The intervals between a sensor's detections when a frame is repeated for ever, and the order with the smallest variance.
#pragma once

#include <optional>
#include <vector>

#include "schedules/sequence/detections.h"

namespace ttf::schedules::sequence {

// The intervals from the beginning of a detection of the sensor, primary or secondary, to the beginning of the next. A picture is
// taken at the beginning. The thesis divides by n - 1. Over many frames its variance becomes that of one frame's intervals.
struct Intervals {
  int detections = 0;  // in a frame
  double mean_s = 0.0;
  double variance = 0.0;  // [s^2]

  double deviation_s() const;
};
// Returns them by sensor. Each sensor has a detection.
std::vector<Intervals> intervals(const Sequence& sequence, const DetectionTimes& times);

// Returns the sensors' mean variance [s^2].
double mean_variance(const Sequence& sequence, const DetectionTimes& times);

// Returns the order of the same detections with the least mean variance: `sequence` itself if no order is better. All orders that
// begin with its first detection are tried, since the frame is repeated. No value if there are more than `most_orders`.
inline constexpr std::uint64_t kMostOrders = 1'000'000;
std::optional<Sequence> best_order(const Sequence& sequence, const DetectionTimes& times,
                                   std::uint64_t most_orders = kMostOrders);
// Returns the number of these orders, at most `limit` + 1.
std::uint64_t orders(const Sequence& sequence, std::uint64_t limit = kMostOrders);

}  // namespace ttf::schedules::sequence
