#include "bus/socketcan/stamp.h"

#include <time.h>

#include <algorithm>

namespace ttf::bus::socketcan {
namespace {

constexpr Duration kUninterrupted = Duration::microseconds(2);
constexpr int kReadings = 3;

std::int64_t realtime_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

ClockPair clock_pair() {
  ClockPair best;
  Duration shortest{};
  for (int reading = 0; reading < kReadings; ++reading) {
    const ports::MachineTime before = ports::host_now();
    const std::int64_t realtime = realtime_ns();
    const ports::MachineTime after = ports::host_now();
    if (reading == 0 || after - before < shortest) {
      shortest = after - before;
      best.host = before + Duration::nanoseconds(shortest.ns / 2);
      best.realtime_ns = realtime;
    }
    best.now = after;
    if (shortest <= kUninterrupted) break;
  }
  return best;
}

ports::MachineTime on_host(std::int64_t stamp_ns, const ClockPair& pair) {
  if (stamp_ns <= 0) return pair.now;
  return std::min(pair.host + Duration::nanoseconds(stamp_ns - pair.realtime_ns), pair.now);
}

}  // namespace ttf::bus::socketcan
