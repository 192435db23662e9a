// The clock of a real machine, CLOCK_MONOTONIC. It waits by a timer of its own, to the nanosecond: the kernel
// may stretch the timeout of poll() by a thousandth.
#pragma once

#include <poll.h>

#include <vector>

#include "nodes/runner/drive_clock.h"
#include "nodes/runner/floor.h"
#include "nodes/runner/machine_clock.h"

namespace ttf::nodes::runner {

class KernelClock final : public MachineClock {
 public:
  // The plain thread beside it wakes by `drive`, and is scheduled like the thread that makes this: ask for
  // privileges before. Throws std::runtime_error if the system refuses a timer.
  explicit KernelClock(const DriveClock& drive);
  ~KernelClock() override;
  KernelClock(const KernelClock&) = delete;
  KernelClock& operator=(const KernelClock&) = delete;

  bus::ports::MachineTime now() const override { return bus::ports::host_now(); }
  void watch(int descriptor) override;
  void clear() override;
  void wait_until(bus::ports::MachineTime until) override;
  void sleep(Duration lasts) override;
  bool readable(int descriptor) const override;
  recording::records::BinnedDurations floor() const override { return floor_.lateness(); }

 private:
  Floor floor_;
  int timer_ = -1;
  std::vector<pollfd> watched_;  // the timer first
};

}  // namespace ttf::nodes::runner
