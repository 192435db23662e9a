// FlexRay clock synchronisation as pure steps: deviations in, corrections out (FlexRay 2.1A, chapter 8).
//
// A deviation is observed minus expected action point of a sync frame, in the receiver's microticks: positive when
// the frame came late, that is when this node's clock is ahead. The node's own sync frame counts as 0. Fault-tolerant
// midpoint: after sorting, the k smallest and k largest are dropped (k = 0 for 1-2 values, 1 for 3-7, 2 for 8-15), the
// result is (smallest + largest of the rest) / 2, rounded towards zero. The algorithm descends from Lundelius Welch and
// Lynch, "A new fault-tolerant algorithm for clock synchronization", Information and Computation 77 (1988).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace ttf::timebase {

inline constexpr int kMaxSyncNodes = 15;

// The midpoint in microticks, nothing for an empty list. Sorts the values in place.
std::optional<int> fault_tolerant_midpoint(std::span<int> deviations);

struct Correction {
  int value = 0;         // microticks, within the limit
  bool missing = false;  // no value was measured: the previous term stays (rate) or is zero (offset)
  bool limit_reached = false;
};

// Deviations of one sync node (identified by its frame id) in one cycle, per channel.
struct SyncDeviation {
  int frame_id = 0;
  std::optional<int> a;
  std::optional<int> b;
};

// What a node measured over a double cycle. Plain data, fixed size.
struct SyncMeasurements {
  std::array<SyncDeviation, kMaxSyncNodes> even{};
  std::array<SyncDeviation, kMaxSyncNodes> odd{};
  int even_count = 0;
  int odd_count = 0;
};

// Offset correction from one cycle's deviations: per node the smaller of its valid channels, midpoint, limit
// +-pOffsetCorrectionOut. Applied by adding it to the length of the odd cycle's NIT: a late frame lengthens it.
Correction offset_correction(std::span<const SyncDeviation> deviations, int limit);

// Rate correction for the next double cycle: midpoint of odd minus even deviations of the same frame (mean of the
// channels valid in both), added to the previous rate; damped by `damping` towards zero; limit +-pRateCorrectionOut.
Correction rate_correction(const SyncMeasurements& measured, int previous, int damping, int limit);

}  // namespace ttf::timebase
