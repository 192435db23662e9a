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
