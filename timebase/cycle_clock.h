// The synchronised clock of one node: maps its microticks to the cluster's cycles and macroticks.
//
// A communication cycle lasts pMicroPerCycle + rate correction microticks, spread evenly over gMacroPerCycle
// macroticks. An offset correction lengthens (positive) or shortens (negative) the macroticks from
// gOffsetCorrectionStart to the cycle's end (FlexRay 2.1A, chapter 8.6.4 and figure 8-12). Macrotick m starts at
// the first microtick at or after its exact share, so no rounding accumulates within or across cycles.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/check.h"
#include "core/time.h"
#include "timebase/divisor.h"

namespace ttf::timebase {

// The parameters of a clock; timebase has no more of schedules.
struct CycleGeometry {
  int macro_per_cycle = 0;  // [MT]
  std::int64_t macrotick_ps = 0;
  int micro_per_cycle = 0;          // [uT]
  int offset_correction_start = 0;  // [MT]
};

class CycleClock {
 public:
  // Cycle `first` starts at microtick `start` with the rate correction `rate` [uT per cycle]. A node that joins
  // a running cluster has its cycle only modulo gCycleCountMax + 1, and counts on from there.
  CycleClock(CycleGeometry geometry, Microticks start, int rate, std::int64_t first = 0);

  std::int64_t cycle() const { return cycle_; }  // running number, never wraps
  Microticks cycle_start() const { return start_; }
  Microticks cycle_end() const;  // start of the next cycle, offset correction included
  // The microtick at which macrotick m (0..gMacroPerCycle) starts.
  Microticks start_of(Macroticks m) const {
    TTF_CHECK(m.value >= 0, "macrotick {}", m.value);
    if (m.value > geometry_.offset_correction_start) return late_start_of(m);
    return start_ + Microticks{macroticks_.ceil(m.value * length_)};
  }
  int rate_correction() const { return rate_; }
  int offset_correction() const { return offset_; }

  // Returns the global time at microtick t of this cycle, in [cycle_start, cycle_end), or before the first
  // cycle. It is the whole macroticks plus the share of the current one, in nanoseconds, rounded down.
  GlobalTime global_time(Microticks t) const {
    const std::int64_t into = (t - start_).value;
    const Stretch& stretch = into <= before_ ? early_ : late_;
    const std::int64_t x = into - stretch.from;
    if (static_cast<std::uint64_t>(x) >= stretch.reach) return exact_global_time(t);
    return {std::min(stretch.begin_ns + stretch.divisor.floor(stretch.rest + x * stretch.slope), stretch.most_ns)};
  }
  // Returns the first microtick of this cycle at which global_time is at or after `time`, at most the cycle's
  // end.
  Microticks when(GlobalTime time) const;

  // Sets the correction of this cycle's correction phase, which must stay longer than zero. To be called before
  // start_of(offset_correction_start).
  void set_offset_correction(int microticks) {
    offset_ = microticks;
    lay_late();
  }
  // Goes to the next cycle with the rate correction `rate` and no offset correction.
  void next_cycle(int rate);

 private:
  // A part of the cycle in which global time is linear. At its microtick x the global time in nanoseconds is
  // begin_ns + floor((rest + x slope) / divisor). The divisor is a thousand times the microticks of the slope:
  // the result equals rounding down to picoseconds first and then to nanoseconds.
  struct Stretch {
    std::int64_t from = 0;       // in the cycle [uT]
    std::uint64_t overflow = 0;  // smaller x cannot overflow while the cycle's beginning does not
    std::uint64_t reach = 0;     // smaller x are computed this way
    std::int64_t begin_ns = 0, rest = 0;
    std::int64_t slope = 0;
    Divisor divisor{1};
    std::int64_t most_ns = 0;  // `before_` is rounded up
  };
  void set_rate(int rate);
  void lay_stretches();
  void lay_late();
  GlobalTime exact_global_time(Microticks t) const;  // for times that overflow 64 bits or lie before the cycle
  Microticks late_start_of(Macroticks m) const;      // behind gOffsetCorrectionStart
  std::int64_t correction_phase() const;             // in microticks, the correction included

  CycleGeometry geometry_;
  Divisor macroticks_, late_macroticks_;  // for the cycle, and for its part from gOffsetCorrectionStart on
  std::int64_t cycle_ps_, late_ps_;       // the same of global time
  std::int64_t most_cycles_;              // fewer cycles cannot overflow
  std::int64_t first_, cycle_;
  Microticks start_{0};
  int rate_ = 0;
  std::int64_t length_ = 0;  // length of the cycle without offset correction [uT]
  std::int64_t before_ = 0;  // its part before gOffsetCorrectionStart [uT]
  int offset_ = 0;
  Stretch early_, late_;  // up to the correction phase, and in it
};

}  // namespace ttf::timebase
