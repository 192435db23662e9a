// What a runner has of its host's time: a clock, and ways to wait by it. All that it knows of time comes through here,
// so that a test can turn its clock; on a real host it is nodes/runner/kernel_clock.h.
//   L1  now() never goes back
//   L2  wait_until() returns at `until` or later; sooner where something watched is there to be read, or a signal came
//   L3  sleep() lasts as long as told or longer, unless a signal came; nothing that is watched shortens it
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

  // Negative descriptors are passed over. Until clear() every wait watches the others.
  virtual void watch(int descriptor) = 0;
  virtual void clear() = 0;
  virtual void wait_until(bus::ports::MachineTime until) = 0;
  virtual void sleep(Duration lasts) = 0;
  // Without waiting; a negative one never is.
  virtual bool readable(int descriptor) const = 0;

  // How late a plain periodic thread beside the runner was woken up so far: that is the machine's lateness.
  virtual recording::records::BinnedDurations floor() const = 0;
};

}  // namespace ttf::nodes::runner
