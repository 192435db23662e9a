// A plain periodic thread beside a node's own. It is only woken up, so its lateness is the machine's, not the
// node's. It is scheduled like the thread that starts it.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "bus/ports/live_medium.h"
#include "core/time.h"
#include "recording/records/binned_durations.h"

namespace ttf::nodes::runner {

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

}  // namespace ttf::nodes::runner
