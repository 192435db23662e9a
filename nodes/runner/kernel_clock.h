// The clock of a real machine, CLOCK_MONOTONIC. It waits by a timer of its own, to the nanosecond: the kernel
// may stretch the timeout of poll() by a thousandth.
#pragma once

#include <poll.h>

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "nodes/runner/drive_clock.h"
#include "nodes/runner/machine_clock.h"
#include "recording/records/binned_durations.h"

namespace ttf::nodes::runner {

// A plain periodic thread beside a node's own. It is only woken up, so its lateness is the machine's, not the
// node's. It is scheduled like the thread that starts it.
class Floor {
 public:
  // Wakes up at `first`, and every period from then on.
  Floor(Duration period, bus::ports::MachineTime first);
  ~Floor();
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  // Returns the latenesses so far.
  recording::records::BinnedDurations lateness() const;

 private:
  void run(Duration period, bus::ports::MachineTime first);

  mutable std::mutex mutex_;
  recording::records::BinnedDurations lateness_;
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

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
