// Sleeps until an absolute instant of the host's clock, or until a descriptor is readable: to the nanosecond the
// kernel is asked for, by a timer of its own (what poll() is given as a time it may stretch by a thousandth).
#pragma once

#include <poll.h>

#include <cstddef>
#include <vector>

#include "bus/ports/live_medium.h"

namespace ttf::nodes::runner {

class WakeUp {
 public:
  // `most`: descriptors watched at a time, at most. Throws std::runtime_error where the system gives no timer.
  explicit WakeUp(std::size_t most);
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  // Negative ones are passed over. Until clear() they are watched by every sleep.
  void watch(int descriptor);
  void clear();
  // Returns at `until` or later; sooner where something is there to be read, or a signal came.
  void sleep_until(bus::ports::HostTime until);

 private:
  int timer_ = -1;
  std::vector<pollfd> watched_;  // the timer first
};

}  // namespace ttf::nodes::runner
