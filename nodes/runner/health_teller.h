// Tells others how a run goes, on a thread of its own: what that takes, words to be formatted and lines to be written,
// is no matter of the thread that the run has to itself.
//
// That thread hands over a plain Health in a place for one, and never waits. Where the one before has not been told
// yet, the new one is left out and counted: health is told once a second, and what counts is how it is now.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "bus/ports/live_medium.h"
#include "nodes/runner/runner.h"

namespace ttf::nodes::runner {

class HealthTeller {
 public:
  // `tell` is called on the other thread, with the instant of the handing over. It must not throw. That thread begins
  // with the priority and on the processors of who makes this: make it before asking for real time.
  explicit HealthTeller(std::function<void(const ttf::nodes::runner::Health&, ttf::bus::ports::MachineTime)> tell);
  ~HealthTeller();  // close()
  HealthTeller(const HealthTeller&) = delete;
  HealthTeller& operator=(const HealthTeller&) = delete;

  // From one thread. Whether it is going to be told.
  bool hand_over(const Health& health);
  // Tells what has been handed over, and ends the thread; nothing may be handed over afterwards.
  void close();
  std::uint64_t left_out() const { return left_out_; }  // for the thread that hands over

 private:
  void run();

  const std::function<void(const ttf::nodes::runner::Health&, ttf::bus::ports::MachineTime)> tell_;
  Health health_;                 // of who hands over while nothing waits, of the other thread while it does
  bus::ports::MachineTime at_{};  // likewise
  std::atomic<bool> waits_{false};
  std::atomic<bool> closing_{false};
  std::uint64_t left_out_ = 0;
  sem_t called_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace ttf::nodes::runner
