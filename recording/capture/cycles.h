// Which communication cycle a captured frame was sent in: from its cycle counter, and from when it was captured.
//
// The counter wraps after gCycleCountMax and may be wrong; the capture's clock runs off the cluster's and knows no
// cycle's start. A frame's slot says how far into its cycle it was sent; so two frames' stamps say how many cycles lie
// between them, to within what clocks may differ (0.15 % each) and what stamping is off. Where counter and stamps
// agree, the counter is believed; where not, the stamps are, and the counter is in error.
#pragma once

#include <cstdint>
#include <optional>

#include "schedules/model/flexray_parameters.h"

namespace ttf::recording::capture {

// What two clocks' rates may differ by: 1500 ppm to either side (cClockDeviationMax).
inline constexpr double kClockDeviation = 0.003;

// When a static slot begins in its cycle, and how long it lasts [ns].
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
    std::int64_t advance = 0;  // cycles from the frame before to this one; never negative
    int counter = 0;           // what the cycle counter must be
    bool counter_fits = true;
  };
  // Frames in the order of time; `slot` is where the frame was, whatever its header says. The first one's counter is
  // believed. A counter that disagrees throughout a cycle is the cluster's new one (it was started anew) and believed
  // from the next frame on. Without stamps, a counter that moves on by more than one is in error, and believed from
  // the next frame on.
  Place place(int slot, int counter, std::optional<std::int64_t> time_ns);

 private:
  std::int64_t offset_ns(int slot) const;
  Place place_by_counter(int counter);
  bool disagrees_for_a_cycle(int by, std::int64_t advance);

  schedules::model::GlobalParameters flexray_;
  std::int64_t cycle_ns_;
  int counters_;  // gCycleCountMax + 1
  bool started_ = false;
  int counter_ = 0;                    // of the current cycle
  std::optional<std::int64_t> start_;  // of the current cycle, by the capture's clock
  int astray_ = 0;                     // frames in a row whose stamps do not fit `start_`
  std::optional<int> disagreement_;    // of the frames before: counter less what is due
  std::int64_t disagreed_cycles_ = 0;
};

}  // namespace ttf::recording::capture
