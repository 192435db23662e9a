// Counts dynamic slots on one channel (FlexRay 2.1A, chapter 5.1.3: flexible TDMA).
//
// The segment is a row of minislots, counted from 1. The slot counter goes on from the last static slot. A
// slot without a transmission lasts one minislot; a transmission extends its slot by whole minislots. Its
// sender stretches it with the dynamic trailing sequence (DTS) to a minislot action point, and
// gdDynamicSlotIdlePhase idle minislots follow. So the counters of two channels may diverge within a cycle,
// but all nodes on a channel count alike.
//
// Interpretation: FlexRay has no rule for activity that lasts into the segment. Here it takes the first slot,
// as if it had begun in minislot 1. No node sends during it, and a node that receives its end counts on from
// there, as after any transmission.
//
// clang-format off
//   minislot   1   2   3   4   5   6   7   8     slot 42 is sent in minislots 2..5 (its DTS ends at the action
//   slot      41  42  42  42  42  42  43  44     point of 5), minislot 6 is idle (gdDynamicSlotIdlePhase 1)
// clang-format on
//
// pLatestTx must let the longest frame end within the segment. schedules/check/checker.h checks this for
// cluster files; schedules/analysis/minislots.h serves frames built by hand.
#pragma once

#include "core/time.h"
#include "schedules/model/flexray_parameters.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus::controller {

class DynamicSlotCounter {
 public:
  explicit DynamicSlotCounter(const schedules::model::GlobalParameters& flexray);

  void start();  // at the beginning of a cycle's segment
  // Returns the slot counter in minislot `minislot` if no further transmission comes before it. Returns 0
  // beyond cSlotIDMax, or if the minislot belongs to a counted transmission.
  int slot_in(int minislot) const;
  // Returns the minislot in which `slot` begins if no further transmission comes before it; 0 if it has passed.
  int minislot_of(int slot) const;
  // Counts activity on the channel from minislot `first` to the end of its DTS, or of any other activity, in
  // minislot `last`. If it overlaps with an earlier transmission, it extends that one's slot.
  void occupied(int first, int last);

 private:
  int first_slot_, idle_phase_;
  int slot_ = 0;  // the counter's value in minislot_
  int minislot_ = 1;
};

// Maps the segment's minislots to a node's clock.
class MinislotGrid {
 public:
  explicit MinislotGrid(const schedules::model::GlobalParameters& flexray);

  int count() const { return count_; }
  Macroticks start_of(int minislot) const;      // 1..count() + 1
  Macroticks action_point(int minislot) const;  // 1..count()
  // Returns the minislot that contains `at`; 0 before the segment, count() + 1 after it.
  int minislot_at(const timebase::CycleClock& clock, Microticks at) const;
  // Returns the last minislot of a transmission whose frame ends at `frame_end`. Its DTS ends at that
  // minislot's action point: the first that leaves room for `shortest_dts`. It may lie beyond count().
  int dts_end(const timebase::CycleClock& clock, Microticks frame_end, Microticks shortest_dts) const;

 private:
  int count_, first_macrotick_, length_, action_point_;
};

}  // namespace ttf::bus::controller
