#include "nodes/runner/floor.h"

#include <time.h>

namespace ttf::nodes::runner {

Floor::Floor(Duration period, bus::ports::MachineTime first) : thread_([this, period, first] { run(period, first); }) {}

Floor::~Floor() {
  stopped_ = true;
  thread_.join();
}

recording::records::BinnedDurations Floor::lateness() const {
  const std::lock_guard lock(mutex_);
  return lateness_;
}

void Floor::run(Duration period, bus::ports::MachineTime first) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (bus::ports::MachineTime next = first; !stopped_; next += period) {
    const timespec until{.tv_sec = next.ns / kSecond, .tv_nsec = next.ns % kSecond};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
    }
    const bus::ports::MachineTime now = bus::ports::host_now();
    {
      const std::lock_guard lock(mutex_);
      lateness_.add(now - next);
    }
    // Several periods slept through are one late wake-up.
    while (next + period <= now) next += period;
  }
}

}  // namespace ttf::nodes::runner
