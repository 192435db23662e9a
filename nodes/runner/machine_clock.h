// A runner's view of time: a clock, and ways to wait by it. All its knowledge of time comes from here, so a
// test can turn the clock; a real machine has nodes/runner/kernel_clock.h.
//   L1  now() never goes back
//   L2  wait_until() returns at `until` or later; sooner if something watched is readable, or a signal came
//   L3  sleep() lasts as long as asked or longer, unless a signal came; watched descriptors do not shorten it
//   L4  nothing allocates after construction
#pragma once

#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "recording/records/binned_durations.h"

namespace ttf::nodes::runner {

class MachineClock {
 public:
  virtual ~MachineClock() = default;

  virtual bus::ports::MachineTime now() const = 0;

  // Watches a descriptor in every wait until clear(); a negative one is ignored.
  virtual void watch(int descriptor) = 0;
  virtual void clear() = 0;
  virtual void wait_until(bus::ports::MachineTime until) = 0;
  virtual void sleep(Duration lasts) = 0;
  // Checks without waiting; a negative descriptor is never readable.
  virtual bool readable(int descriptor) const = 0;

  // Returns how late a plain periodic thread beside the runner has been woken up so far: the machine's lateness.
  virtual recording::records::BinnedDurations floor() const = 0;
};

}  // namespace ttf::nodes::runner
