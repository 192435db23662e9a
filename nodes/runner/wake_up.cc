#include "nodes/runner/wake_up.h"

#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "core/check.h"

namespace ttf::nodes::runner {

WakeUp::WakeUp(std::size_t most) : timer_(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)) {
  if (timer_ < 0) throw std::system_error(errno, std::system_category(), "no timer");
  watched_.reserve(most + 1);
  watched_.push_back({timer_, POLLIN, 0});
}

WakeUp::~WakeUp() { close(timer_); }

void WakeUp::watch(int descriptor) {
  if (descriptor < 0) return;
  TTF_CHECK(watched_.size() < watched_.capacity(), "{} descriptors", watched_.size());
  watched_.push_back({descriptor, POLLIN, 0});
}

void WakeUp::clear() { watched_.resize(1); }

void WakeUp::sleep_until(bus::ports::HostTime until) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  // 0 would switch the timer off.
  const std::int64_t at = std::max<std::int64_t>(until.ns, 1);
  const itimerspec when{.it_interval = {}, .it_value = {.tv_sec = at / kSecond, .tv_nsec = at % kSecond}};
  // Setting it anew also takes back an expiry that nobody has read.
  timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr);
  (void)poll(watched_.data(), watched_.size(), -1);
}

}  // namespace ttf::nodes::runner
