// Node sets by the kernel's clock, a thread each. Their lateness is the machine's: it is reported without
// judgement, and may break a cluster up. The assertions hold at any lateness. A runner's treatment of its
// lateness is tested by a turned clock: runner_test.cc, node_set_test.cc.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include "core/time.h"
#include "nodes/runner/kernel_clock.h"
#include "recording/records/enumerations.h"
#include "tests/nodes/runner/live_node_set.h"

namespace ttf::nodes::runner {
namespace {

class WallClockNodeSet : public LiveNodeSet {
 protected:
  void drive(const Drive& how) {
    const std::size_t nodes = cluster_.nodes.size();
    recorded_.assign(nodes, {});
    health_.assign(nodes, {});
    const DriveClock clock(bus::ports::host_now() + ms(50), how.scale_ppm);
    const auto media = this->media(how, clock, bus::ports::host_now);
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < nodes; ++n)
      threads.emplace_back([&, n] {
        const auto node = static_cast<NodeId>(n);
        const RunnerConfig config = config_of(how, clock, node);
        KernelClock host(clock);
        Runner runner(config, steps_of(node), *media[n], host, recorded_[n]);
        EXPECT_EQ(runner.run(), RunnerEnd::kDone);
        EXPECT_GE(clock.drive_time(host.now()), config.end);
        health_[n] = runner.health();
      });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t n = 0; n < nodes; ++n) {
      SCOPED_TRACE(cluster_.nodes[n].name);
      expect_counted_once(recorded_[n], health_[n]);
    }
    expect_nothing_vanished(media);
    report();
  }
  // For people who read the test's output, now or in a year.
  void report() {
    fmt::print("{:<12}{:>12}{:>12}{:>12}{:>12}{:>10}{:>8}  state\n", "us late", "wake-up p50", "p99", "longest",
               "floor", "withheld", "lost");
    for (std::size_t n = 0; n < recorded_.size(); ++n) {
      const Health& health = health_[n];
      fmt::print("{:<12}{:>12.0f}{:>12.0f}{:>12.0f}{:>12.0f}{:>10}{:>8}  {}\n", cluster_.nodes[n].name,
                 in_us(health.wakeup_p50), in_us(health.wakeup_p99), in_us(health.wakeup_longest),
                 in_us(recorded_[n].lateness[recording::records::LatenessOf::kFloor].longest),
                 health.timing.slots_missed, health.timing.frames_lost,
                 health.state ? to_text(*health.state) : "off FlexRay");
    }
    std::fflush(stdout);
  }
};

TEST_F(WallClockNodeSet, DrivesFromAnIntegratedStart) {
  drive({.scale_ppm = 4'000'000});
  EXPECT_TRUE(std::is_sorted(of("laser").measured.begin(), of("laser").measured.end()));
  for (const char* node : kOnFlexRay) EXPECT_FALSE(of(node).frames.empty() && of(node).problems.empty()) << node;
}

TEST_F(WallClockNodeSet, DrivesFromAColdStart) {
  drive({.scale_ppm = 4'000'000, .power_on = [](NodeId node) {
           return std::optional(sim::engine::kFirstCycle + ms(3) * static_cast<std::int64_t>(index_of(node)));
         }});
  for (const char* node : kOnFlexRay) EXPECT_FALSE(of(node).states.empty()) << node;
}

}  // namespace
}  // namespace ttf::nodes::runner
