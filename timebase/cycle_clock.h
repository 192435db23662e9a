// The synchronised clock of one node: where its microticks stand in the cluster's cycles and macroticks.
//
// A communication cycle lasts pMicroPerCycle + rate correction microticks, spread evenly over gMacroPerCycle
// macroticks; an offset correction lengthens (positive) or shortens (negative) the macroticks from
// gOffsetCorrectionStart to the cycle's end (FlexRay 2.1A, chapter 8.6.4 and figure 8-12). Macrotick m starts at the
// first microtick at or after its exact share, so no rounding accumulates within or across cycles.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/check.h"
#include "core/time.h"
#include "timebase/divisor.h"

namespace ttf::timebase {

// The parameters a clock needs (timebase does not know schedules beyond this struct).
struct CycleGeometry {
  int macro_per_cycle = 0;  // [MT]
  std::int64_t macrotick_ps = 0;
  int micro_per_cycle = 0;          // [uT]
  int offset_correction_start = 0;  // [MT]
};

class CycleClock {
 public:
  // Cycle `first` starts at microtick `start`; `rate` [uT per cycle] is in force from it on. A node that joins a
  // running cluster knows its cycle only modulo gCycleCountMax + 1, and counts on from there.
  CycleClock(CycleGeometry geometry, Microticks start, int rate, std::int64_t first = 0);

  std::int64_t cycle() const { return cycle_; }  // running number, never wraps
  Microticks cycle_start() const { return start_; }
  Microticks cycle_end() const;  // start of the next cycle, offset correction included
  // Microtick at which macrotick m (0..gMacroPerCycle) starts.
  Microticks start_of(Macroticks m) const {
    TTF_CHECK(m.value >= 0, "macrotick {}", m.value);
    if (m.value > geometry_.offset_correction_start) return late_start_of(m);
    return start_ + Microticks{macroticks_.ceil(m.value * length_)};
  }
  int rate_correction() const { return rate_; }
  int offset_correction() const { return offset_; }

  // Global time at microtick t of this cycle, [cycle_start, cycle_end), or before the first cycle (then earlier than
  // it): whole macroticks plus the share of the current one, in nanoseconds, rounded down.
  GlobalTime global_time(Microticks t) const {
    const std::int64_t into = (t - start_).value;
    const Stretch& stretch = into <= before_ ? early_ : late_;
    const std::int64_t x = into - stretch.from;
    if (static_cast<std::uint64_t>(x) >= stretch.reach) return exact_global_time(t);
    return {std::min(stretch.begin_ns + stretch.divisor.floor(stretch.rest + x * stretch.slope), stretch.most_ns)};
  }
  // First microtick of this cycle at which global_time is at or after `time`; the cycle's end where it is later.
  Microticks when(GlobalTime time) const;

  // To be applied in this cycle's correction phase, which it must not use up; must be set before
  // start_of(offset_correction_start).
  void set_offset_correction(int microticks) {
    offset_ = microticks;
    lay_late();
  }
  // Goes to the next cycle; `rate` is in force from there on. The offset correction is used up.
  void next_cycle(int rate);

 private:
  // A part of the cycle in which global time is linear: at its microtick x it is, in nanoseconds,
  // begin_ns + floor((rest + x slope) / divisor). The divisor is a thousand times the microticks that the slope is
  // spread over: rounding down to picoseconds first and then to nanoseconds comes to the same.
  struct Stretch {
    std::int64_t from = 0;       // in the cycle [uT]
    std::uint64_t overflow = 0;  // x below this are none, as long as the cycle's beginning is none
    std::uint64_t reach = 0;     // x below this are computed so
    std::int64_t begin_ns = 0, rest = 0;
    std::int64_t slope = 0;
    Divisor divisor{1};
    std::int64_t most_ns = 0;  // `before_` is rounded up
  };
  void set_rate(int rate);
  void lay_stretches();
  void lay_late();
  GlobalTime exact_global_time(Microticks t) const;  // whatever overflows 64 bits, and before the cycle
  Microticks late_start_of(Macroticks m) const;      // behind gOffsetCorrectionStart
  std::int64_t correction_phase() const;             // its microticks, the correction included

  CycleGeometry geometry_;
  Divisor macroticks_, late_macroticks_;  // of the cycle, and of its part from gOffsetCorrectionStart on
  std::int64_t cycle_ps_, late_ps_;       // the same of global time
  std::int64_t most_cycles_;              // so many are no overflow
  std::int64_t first_, cycle_;
  Microticks start_{0};
  int rate_ = 0;
  std::int64_t length_ = 0;  // of the cycle without offset correction [uT]
  std::int64_t before_ = 0;  // of it, before gOffsetCorrectionStart
  int offset_ = 0;
  Stretch early_, late_;  // up to the correction phase, and in it
};

}  // namespace ttf::timebase
