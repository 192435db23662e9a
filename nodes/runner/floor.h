// A plain periodic thread beside a node's own: it does nothing but be woken up, so what it is late by is the
// machine's, not the node's. Scheduled as the thread that starts it is.
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
  // Woken up at `first`, and every period from then on.
  Floor(Duration period, bus::ports::MachineTime first);
  ~Floor();
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  // So far.
  recording::records::BinnedDurations lateness() const;

 private:
  void run(Duration period, bus::ports::MachineTime first);

  mutable std::mutex mutex_;
  recording::records::BinnedDurations lateness_;
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

}  // namespace ttf::nodes::runner
