// Reports how a run goes, on a thread of its own: formatting and writing lines takes no time of the node's
// thread.
//
// The node's thread hands over a plain Health in a place for one, and never waits. While the previous one is not yet
// reported, a new one is left out and counted: health is reported once a second, and only the present state counts.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "bus/ports/live_medium.h"
#include "nodes/runner/runner.h"

namespace ttf::nodes::runner {

class HealthReporter {
 public:
  // `report` is called on the other thread, with the instant of the handing over. It must not throw. The other
  // thread inherits the maker's priority and processors, so make it before asking for real time.
  explicit HealthReporter(std::function<void(const ttf::nodes::runner::Health&, ttf::bus::ports::MachineTime)> report);
  ~HealthReporter();  // close()
  HealthReporter(const HealthReporter&) = delete;
  HealthReporter& operator=(const HealthReporter&) = delete;

  // Hands health over, always from one thread. Returns whether it will be reported.
  bool hand_over(const Health& health);
  // Reports the health handed over, and ends the thread; nothing may be handed over afterwards.
  void close();
  std::uint64_t left_out() const { return left_out_; }  // for the thread that hands over

 private:
  void run();

  const std::function<void(const ttf::nodes::runner::Health&, ttf::bus::ports::MachineTime)> report_;
  Health health_;                 // belongs to the thread that hands over, and to the other one while health waits
  bus::ports::MachineTime at_{};  // likewise
  std::atomic<bool> waits_{false};
  std::atomic<bool> closing_{false};
  std::uint64_t left_out_ = 0;
  sem_t called_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace ttf::nodes::runner
