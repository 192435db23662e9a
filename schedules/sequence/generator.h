// Generates the sequence of a frame from measured times and a bound: secondary detections fill the time that the primary ones
// leave.
//
// With P the sum of the primary detections' times, s the time of a secondary one and the bound b, t = max(b - P, 0) is free, and
//   m = floor(t / s) + 1  slots (kText),  or  m = floor(t / s)  (kFloor).
// There is none without free time, without a sensor of interest, and while s is not known (0). So a frame lasts at most b + s, and
// at most b by kFloor, if P <= b. Otherwise it lasts P.
// The r sensors of interest take the slots in blocks: slot i of 1..m belongs to number ceil(i r / m) of them. The slots fill
// columns of n places for n sensors. The last column may have blanks. A permutation w mixes each column: its place k has the slot
// w(k). A sensor's row is its primary detection, then its place in every column. The sequence is all rows, one after another.
//   kText      w = 1, h + 1, 2, h + 2, ... with h = ceil(n / 2): one of the first half, one of the second, in turn
//   kReversed  w = n, ..., 1
//
// The thesis (detections.h) has kText and kText in its text, and kFloor and kReversed in its program. Three mistakes are not kept.
// The text's ceil(i r / m) + 1 contradicts its example. Its formula for w is no permutation. The program takes the number of a
// sensor of interest for the number of a sensor, which is right only if those of interest come first.
#pragma once

#include <span>

#include "schedules/sequence/detections.h"

namespace ttf::schedules::sequence {

enum class SlotRule { kText, kFloor };
enum class SlotOrder { kText, kReversed };

struct FrameRequest {
  int sensors = 0;                // 1..kMostSensors
  std::span<const int> interest;  // sensors with a region of interest: ascending, none twice
  Duration primaries{};           // the sum of a primary detection of each sensor
  Duration secondary{};           // 0: not known
  Duration bound{};
  SlotRule slots = SlotRule::kText;
  SlotOrder order = SlotOrder::kText;
};

// A frame has at most so many secondary detections, however short they are.
inline constexpr int kMostSecondaries = 1000;

// Returns m, at most kMostSecondaries.
int free_slots(const FrameRequest& request);
// Returns w(place) for a place of 1..sensors.
int permuted(SlotOrder order, int place, int sensors);

// Replaces `sequence`. Allocates nothing if it has room for the sensors and kMostSecondaries.
void generate(const FrameRequest& request, Sequence& sequence);
Sequence generated(const FrameRequest& request);

}  // namespace ttf::schedules::sequence
