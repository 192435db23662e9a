// Counting in the dynamic segment of one channel (FlexRay 2.1A, chapter 5.1.3: flexible TDMA).
//
// The segment is a row of minislots, counted from 1. The slot counter goes on from the last static slot. A
// slot in which nobody sends lasts one minislot; a transmission makes its slot last as many whole minislots
// as it needs: its sender stretches it with the dynamic trailing sequence (DTS) to a minislot action point,
// and gdDynamicSlotIdlePhase idle minislots follow. So the counters of two channels may diverge within a
// cycle, but every node on a channel counts alike.
//
// Reading taken of what is on the channel already when the segment begins, which FlexRay has nothing of its own for:
// it takes the first slot, as if it had begun in minislot 1. Nobody sends while it lasts, and whoever hears it end
// counts on from there, as behind any transmission.
//
// clang-format off
//   minislot   1   2   3   4   5   6   7   8     slot 42 is sent in minislots 2..5 (its DTS ends at the action
//   slot      41  42  42  42  42  42  43  44     point of 5), minislot 6 is idle (gdDynamicSlotIdlePhase 1)
// clang-format on
//
// pLatestTx must be such that the longest frame ends within the segment: schedules/check/checker.h sees to it in
// cluster files, a designer of frames by hand keeps schedules/analysis/minislots.h.
#pragma once

#include "core/time.h"
#include "schedules/model/flexray_parameters.h"
#include "timebase/cycle_clock.h"

namespace ttf::bus::controller {

class DynamicSlotCounter {
 public:
  explicit DynamicSlotCounter(const schedules::model::GlobalParameters& flexray);

  void start();  // of a cycle's segment
  // The slot counter in minislot `minislot`, no further transmissions before it; 0 where it has passed
  // cSlotIDMax or where the minislot belongs to a transmission that has been counted.
  int slot_in(int minislot) const;
  // The minislot in which `slot` begins, no further transmissions before it; 0 where its turn is over.
  int minislot_of(int slot) const;
  // The channel was taken from `first` to the end of the DTS (or of whatever it was) in minislot `last`. What
  // overlaps with an earlier transmission extends that one's slot.
  void occupied(int first, int last);

 private:
  int first_slot_, idle_phase_;
  int slot_ = 0;  // the counter's value in minislot_
  int minislot_ = 1;
};

// Where the segment's minislots are on a node's clock.
class MinislotGrid {
 public:
  explicit MinislotGrid(const schedules::model::GlobalParameters& flexray);

  int count() const { return count_; }
  Macroticks start_of(int minislot) const;      // 1..count() + 1
  Macroticks action_point(int minislot) const;  // 1..count()
  // The minislot that `at` lies in; 0 before the segment, count() + 1 after it.
  int minislot_at(const timebase::CycleClock& clock, Microticks at) const;
  // For a sender: the minislot at whose action point the DTS of a frame ends that would else end at
  // `frame_end`: the first one that leaves room for a DTS of `shortest_dts`. May lie beyond count().
  int dts_end(const timebase::CycleClock& clock, Microticks frame_end, Microticks shortest_dts) const;

 private:
  int count_, first_macrotick_, length_, action_point_;
};

}  // namespace ttf::bus::controller
