// The clock of a real host, and the plain thread beside it.
#include "nodes/runner/kernel_clock.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdint>

#include "tests/nodes/runner/machine_clock_laws.h"

namespace ttf::nodes::runner {
namespace {

struct KernelBench {
  MachineClock& clock() { return own; }
  KernelClock own{DriveClock(bus::ports::host_now(), 1'000'000)};
};
INSTANTIATE_TYPED_TEST_SUITE_P(Kernel, MachineClockLaws, KernelBench);

TEST(Floor, CountsEveryWakeUpOnce) {
  constexpr Duration kPeriod = Duration::milliseconds(1);
  const bus::ports::MachineTime first = bus::ports::host_now() + kPeriod;
  recording::records::BinnedDurations lateness;
  {
    Floor floor(kPeriod, first);
    while (floor.lateness().empty()) sched_yield();
    lateness = floor.lateness();
  }
  EXPECT_LE(static_cast<std::int64_t>(lateness.count()), (bus::ports::host_now() - first).ns / kPeriod.ns + 1);
  EXPECT_GE(lateness.longest(), Duration{});
}

}  // namespace
}  // namespace ttf::nodes::runner
