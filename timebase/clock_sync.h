// FlexRay clock synchronisation as pure steps: deviations in, corrections out (FlexRay 2.1A, chapter 8).
//
// A deviation is the observed minus the expected action point of a sync frame, in the receiver's microticks. It
// is positive for a late frame: this node's clock is then ahead. The node's own sync frame counts as 0.
// Fault-tolerant midpoint: sort, and drop the k smallest and k largest values (k = 0 for 1-2 values, 1 for 3-7,
// 2 for 8-15). The result is (smallest + largest of the rest) / 2, rounded towards zero. The algorithm descends
// from Lundelius Welch and Lynch, "A new fault-tolerant algorithm for clock synchronization", Information and
// Computation 77 (1988).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace ttf::timebase {

inline constexpr int kMaxSyncNodes = 15;

// Returns the midpoint in microticks, nullopt for an empty list. Sorts the values in place.
std::optional<int> fault_tolerant_midpoint(std::span<int> deviations);

struct Correction {
  int value = 0;         // microticks, within the limit
  bool missing = false;  // no value was measured: the previous term stays (rate) or is zero (offset)
  bool limit_reached = false;
};

// The deviations of one sync node (identified by its frame id) in one cycle, per channel.
struct SyncDeviation {
  int frame_id = 0;
  std::optional<int> a;
  std::optional<int> b;
};

// The measurements of a node over a double cycle. Plain data, fixed size.
struct SyncMeasurements {
  std::array<SyncDeviation, kMaxSyncNodes> even{};
  std::array<SyncDeviation, kMaxSyncNodes> odd{};
  int even_count = 0;
  int odd_count = 0;
};

// Returns the offset correction from one cycle's deviations: the midpoint over the smaller valid channel of each
// node, limited to +-pOffsetCorrectionOut. It is added to the length of the odd cycle's NIT: a late frame
// lengthens it.
Correction offset_correction(std::span<const SyncDeviation> deviations, int limit);

// Returns the rate correction for the next double cycle. The midpoint of odd minus even deviations of the same
// frame (mean of the channels valid in both) is added to the previous rate. The sum is damped by `damping`
// towards zero and limited to +-pRateCorrectionOut.
Correction rate_correction(const SyncMeasurements& measured, int previous, int damping, int limit);

}  // namespace ttf::timebase
