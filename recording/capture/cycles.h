// Finds the communication cycle in which a captured frame was sent, from its cycle counter and its stamp.
//
// The counter wraps after gCycleCountMax and may be wrong. The capture's clock drifts against the cluster's and
// has no start of a cycle. A frame's slot gives its offset in the cycle. Two frames' stamps thus give the
// number of cycles between them, to within the clocks' drift (0.15 % each) and the error of the stamps. If
// counter and stamps agree, the counter counts; if not, the stamps count, and the counter is in error.
#pragma once

#include <cstdint>
#include <optional>

#include "schedules/model/flexray_parameters.h"

namespace ttf::recording::capture {

// The largest difference between two clocks' rates: 1500 ppm to either side (cClockDeviationMax).
inline constexpr double kClockDeviation = 0.003;

// Returns the offset of a static slot in its cycle; the next function returns its length [ns].
inline std::int64_t static_slot_offset_ns(const schedules::model::GlobalParameters& flexray, int slot) {
  return std::int64_t{slot - 1} * flexray.gdStaticSlot * flexray.gdMacrotick_ps / 1000;
}
inline std::int64_t slot_length_ns(const schedules::model::GlobalParameters& flexray) {
  return static_slot_offset_ns(flexray, 2);
}

class CycleTracker {
 public:
  explicit CycleTracker(const schedules::model::GlobalParameters& flexray);

  struct Place {
    std::int64_t advance = 0;  // cycles from the previous frame to this one; never negative
    int counter = 0;           // the correct value of the cycle counter
    bool counter_fits = true;
  };
  // Places one frame; frames come in the order of time. `slot` is where the frame was, whatever its header
  // says. The first frame's counter is taken as right. A counter that disagrees throughout a cycle is the
  // counter of a restarted cluster, and is right from the next frame on. Without stamps, a counter that moves
  // on by more than one is in error, and right from the next frame on.
  Place place(int slot, int counter, std::optional<std::int64_t> time_ns);

 private:
  std::int64_t offset_ns(int slot) const;
  Place place_by_counter(int counter);
  bool disagrees_for_a_cycle(int by, std::int64_t advance);

  schedules::model::GlobalParameters flexray_;
  std::int64_t cycle_ns_;
  int counters_;  // gCycleCountMax + 1
  bool started_ = false;
  int counter_ = 0;                    // the current cycle's
  std::optional<std::int64_t> start_;  // the current cycle's, by the capture's clock
  int astray_ = 0;                     // frames in a row whose stamps do not fit `start_`
  std::optional<int> disagreement_;    // in the previous frames: counter minus the correct value
  std::int64_t disagreed_cycles_ = 0;
};

}  // namespace ttf::recording::capture
