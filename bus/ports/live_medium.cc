#include "bus/ports/live_medium.h"

#include <time.h>

namespace ttf::bus::ports {

MachineTime host_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return {static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec};
}

}  // namespace ttf::bus::ports
