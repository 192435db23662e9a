// Laws of nodes/runner/health_reporter.h: handing over never waits, and reports are unchanged.
#include "nodes/runner/health_reporter.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>
#include <utility>
#include <vector>

namespace ttf::nodes::runner {
namespace {

Health health_of(std::uint64_t number) {
  Health health;
  health.timing.late_wakeups = number;
  health.dropped = 2 * number;
  health.wakeup_longest = Duration::microseconds(static_cast<std::int64_t>(number));
  health.state = bus::poc::PocKind::kNormalActive;
  return health;
}

TEST(HealthReporter, ReportsOnAThreadOfItsOwn) {
  std::promise<std::pair<Health, bus::ports::MachineTime>> reported;
  std::promise<std::thread::id> who;
  const bus::ports::MachineTime before = bus::ports::host_now();
  HealthReporter reporter([&](const Health& health, bus::ports::MachineTime at) {
    reported.set_value({health, at});
    who.set_value(std::this_thread::get_id());
  });
  EXPECT_TRUE(reporter.hand_over(health_of(7)));
  const auto [health, at] = reported.get_future().get();  // without further reports
  EXPECT_EQ(health.timing.late_wakeups, 7u);
  EXPECT_EQ(health.dropped, 14u);
  EXPECT_EQ(health.wakeup_longest, Duration::microseconds(7));
  EXPECT_EQ(health.state, bus::poc::PocKind::kNormalActive);
  EXPECT_GE(at, before);
  EXPECT_LE(at, bus::ports::host_now());
  EXPECT_NE(who.get_future().get(), std::this_thread::get_id());
}

// While one is being reported, for however long, new ones are left out and counted; the next one after it is
// reported.
TEST(HealthReporter, HandingOverNeverWaits) {
  std::promise<void> begun, go_on;
  std::vector<std::uint64_t> reported;
  HealthReporter reporter([&](const Health& health, bus::ports::MachineTime) {
    reported.push_back(health.dropped);
    if (reported.size() > 1) return;
    begun.set_value();
    go_on.get_future().wait();
  });
  EXPECT_TRUE(reporter.hand_over(health_of(0)));
  begun.get_future().wait();
  // Waiting for the other thread here would hang.
  for (std::uint64_t i = 1; i <= 10'000; ++i) EXPECT_FALSE(reporter.hand_over(health_of(i)));
  EXPECT_EQ(reporter.left_out(), 10'000u);
  go_on.set_value();
  while (!reporter.hand_over(health_of(20'000))) std::this_thread::yield();
  reporter.close();
  EXPECT_EQ(reported, (std::vector<std::uint64_t>{0, 40'000}));
}

TEST(HealthReporter, HealthsThatWereHandedOverAreReportedBeforeItIsClosed) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::uint64_t reported = 0;
    HealthReporter reporter(
        [&](const Health& health, bus::ports::MachineTime) { reported = health.timing.late_wakeups; });
    ASSERT_TRUE(reporter.hand_over(health_of(i + 1)));
    reporter.close();
    ASSERT_EQ(reported, i + 1);
  }
}

// Each report is whole at any time: never half of one and half of the next.
TEST(HealthReporter, ReportsAreWholeAndInOrder) {
  std::uint64_t last = 0, reported = 0;
  HealthReporter reporter([&](const Health& health, bus::ports::MachineTime) {
    EXPECT_EQ(health.dropped, 2 * health.timing.late_wakeups);
    EXPECT_GT(health.timing.late_wakeups, last);
    last = health.timing.late_wakeups;
    ++reported;
  });
  std::uint64_t taken = 0;
  for (std::uint64_t i = 1; i <= 100'000; ++i) taken += reporter.hand_over(health_of(i)) ? 1 : 0;
  reporter.close();
  EXPECT_EQ(reported, taken);
  EXPECT_EQ(taken + reporter.left_out(), 100'000u);
}

}  // namespace
}  // namespace ttf::nodes::runner
