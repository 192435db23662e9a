#include "nodes/runner/kernel_clock.h"

#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include "core/check.h"
#include "schedules/model/limits.h"

namespace ttf::nodes::runner {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr Duration kFloorPeriod = Duration::milliseconds(5);
constexpr Duration kFloorPhase = Duration::microseconds(3500);  // off whole milliseconds, where cycles begin
constexpr std::size_t kMostWatched =
    1 + 2 + schedules::model::kMostCans + 2;  // the timer, all lines, a stop descriptor, the vehicle's line

}  // namespace

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

KernelClock::KernelClock(const DriveClock& drive)
    : floor_(kFloorPeriod, drive.next_turn(kFloorPeriod, kFloorPhase, bus::ports::host_now())),
      timer_(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)) {
  if (timer_ < 0) throw std::system_error(errno, std::system_category(), "cannot open a timer");
  watched_.reserve(kMostWatched);
  watched_.push_back({timer_, POLLIN, 0});
}

KernelClock::~KernelClock() { close(timer_); }

void KernelClock::watch(int descriptor) {
  if (descriptor < 0) return;
  TTF_CHECK(watched_.size() < kMostWatched, "{} descriptors", watched_.size());
  watched_.push_back({descriptor, POLLIN, 0});
}

void KernelClock::clear() { watched_.resize(1); }

void KernelClock::wait_until(bus::ports::MachineTime until) {
  // 0 would switch the timer off.
  const std::int64_t at = std::max<std::int64_t>(until.ns, 1);
  const itimerspec when{.it_interval = {}, .it_value = {.tv_sec = at / kSecond, .tv_nsec = at % kSecond}};
  // Setting it anew also takes back an unread expiry.
  timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr);
  (void)poll(watched_.data(), watched_.size(), -1);
}

void KernelClock::sleep(Duration lasts) {
  const timespec time{.tv_sec = lasts.ns / kSecond, .tv_nsec = lasts.ns % kSecond};
  nanosleep(&time, nullptr);
}

bool KernelClock::readable(int descriptor) const {
  if (descriptor < 0) return false;
  pollfd one{descriptor, POLLIN, 0};
  return poll(&one, 1, 0) > 0;
}

}  // namespace ttf::nodes::runner
