// Every node in its own process (here a thread, with only messages between them) makes the same records as in
// one process that simulates all.
#include "sim/processes/turn_taking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/random.h"
#include "schedules/check/checker.h"
#include "tests/recording/record_text.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/memory_exchange.h"

namespace ttf::sim::processes {
namespace {

using sim::drives::Drive;
using Lines = std::vector<std::string>;

// The clocks' largest difference is not recorded when no process sees two clocks.
Lines sorted_without_precision(Lines lines) {
  std::erase_if(lines, [](const std::string& line) { return line.starts_with("/precision "); });
  std::sort(lines.begin(), lines.end());
  return lines;
}

Lines in_one_process(const Drive& drive) {
  recording::TextSink sink;
  drive.run(sink, drive.scenario.seed);
  return sorted_without_precision(std::move(sink.lines));
}

// Wraps the exchange between a node and the others, for tests that interfere.
using Wrap =
    std::function<std::unique_ptr<bus::ports::Exchange>(ttf::NodeId, std::unique_ptr<ttf::bus::ports::Exchange>)>;

// Each node's process' records. A process that fails with Killed is gone from then on; any other failure is
// the test's.
struct Killed {};
std::vector<Lines> in_processes(const Drive& drive, const Wrap& wrap = {}) {
  test::MemoryExchange hub;
  const std::size_t nodes = drive.cluster.nodes.size();
  std::vector<std::unique_ptr<bus::ports::Exchange>> ports;
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto id = static_cast<NodeId>(n);
    ports.push_back(wrap ? wrap(id, hub.join(id)) : hub.join(id));
  }
  std::vector<recording::TextSink> sinks(nodes);
  std::vector<std::exception_ptr> failures(nodes);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < nodes; ++n)
    threads.emplace_back([&, n] {
      const auto id = static_cast<NodeId>(n);
      try {
        TurnTaking others(drive.cluster, id, *ports[n]);
        sim::drives::run_drive(
            {&drive.scenario, &drive.cluster, drive.strategy, drive.scenario.seed, 0, nullptr, &others}, sinks[n]);
      } catch (const Killed&) {
        hub.leave(id);
      } catch (...) {
        failures[n] = std::current_exception();
        hub.leave(id);
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  std::vector<Lines> lines;
  for (recording::TextSink& sink : sinks) lines.push_back(std::move(sink.lines));
  return lines;
}

Lines together(const std::vector<Lines>& shares) {
  Lines all;
  for (const Lines& share : shares) all.insert(all.end(), share.begin(), share.end());
  return sorted_without_precision(std::move(all));
}

void expect_equal(const Lines& found, const Lines& expected) {
  ASSERT_GT(expected.size(), 1000u);
  EXPECT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) ASSERT_EQ(found[i], expected[i]);
}

struct Case {
  const char* name;
  const char* scenario;
  fusion::strategies::StrategyKind strategy;
  std::int64_t milliseconds;
  bool guarded = false;           // in a star with guardians
  const char* cluster = nullptr;  // in place of the scenario's
  bool cold = false;

  Drive drive() const {
    Drive drive(scenario, strategy);
    if (cluster != nullptr) drive.cluster = schedules::check::load_checked_cluster(sim::drives::shipped(cluster));
    drive.scenario.startup.cold = drive.scenario.startup.cold || cold;
    drive.scenario.duration = Duration::milliseconds(milliseconds);
    if (guarded) {
      drive.cluster.topology = schedules::model::Topology::kStar;
      drive.cluster.guardian = true;
    }
    return drive;
  }
};

class TurnTakingOf : public testing::TestWithParam<Case> {};

TEST_P(TurnTakingOf, LeavesTheRecordsOfASingleProcess) {
  const Drive drive = GetParam().drive();
  expect_equal(together(in_processes(drive)), in_one_process(drive));
}

constexpr const char* kAhead = "scenarios/paper_scenario1.yaml";
constexpr const char* kOverCan = "schedules/paper_free_running.yaml";
constexpr const char* kOverFlexRay = "schedules/paper_free_flexray.yaml";

// The cold drives have frames in the dynamic segment. Sensors that follow their hosts are triggered through
// another process' messages. Lists over FlexRay activate tasks.
INSTANTIATE_TEST_SUITE_P(
    Drives, TurnTakingOf,
    testing::Values(
        Case{"Buff", "scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kBuff, 700},
        Case{"Adva", "scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kAdva, 700},
        Case{"Tt", "scenarios/paper_scenario2.yaml", fusion::strategies::StrategyKind::kTt, 700},
        Case{"NamedSensors", "scenarios/two_lasers.yaml", fusion::strategies::StrategyKind::kTt, 700},
        Case{"ClosedLoop", "scenarios/acc_braking_lead.yaml", fusion::strategies::StrategyKind::kTt, 3'000},
        Case{"ClosedLoopBuff", "scenarios/acc_braking_lead.yaml", fusion::strategies::StrategyKind::kBuff, 1'000},
        Case{"ColdStart", "scenarios/cold_start.yaml", fusion::strategies::StrategyKind::kTt, 700},
        Case{"GuardedColdStart", "scenarios/cold_start.yaml", fusion::strategies::StrategyKind::kTt, 700, true},
        Case{"Faults", "scenarios/faulty_bus.yaml", fusion::strategies::StrategyKind::kTt, 2700},
        Case{"GuardedFaults", "scenarios/faulty_bus.yaml", fusion::strategies::StrategyKind::kTt, 2700, true},
        Case{"CanFaults", "scenarios/faulty_can.yaml", fusion::strategies::StrategyKind::kTt, 2700},
        Case{"FollowingBuff", kAhead, fusion::strategies::StrategyKind::kBuff, 700, false, kOverCan},
        Case{"FollowingAdva", kAhead, fusion::strategies::StrategyKind::kAdva, 700, false, kOverCan},
        Case{"FollowingColdStart", kAhead, fusion::strategies::StrategyKind::kAdva, 700, false, kOverCan, true},
        Case{"FollowingOverFlexRay", kAhead, fusion::strategies::StrategyKind::kAdva, 700, false, kOverFlexRay},
        Case{"FollowingOverFlexRayColdStart", kAhead, fusion::strategies::StrategyKind::kAdva, 700, false, kOverFlexRay,
             true}),
    [](const auto& one) { return std::string(one.param.name); });

constexpr Case kShort{"", "scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kTt, 300};

// Stops at drawn messages for drawn times.
class Dawdling final : public bus::ports::Exchange {
 public:
  Dawdling(std::unique_ptr<bus::ports::Exchange> port, std::uint64_t seed, NodeId node)
      : port_(std::move(port)), draws_({seed, 0, Purpose::kTest, static_cast<std::uint16_t>(node), 0}) {}
  void send(std::span<const std::byte> message) override {
    dawdle();
    port_->send(message);
  }
  Received receive() override {
    dawdle();
    return port_->receive();
  }

 private:
  void dawdle() {
    if (draws_.integer(0, 63) == 0) std::this_thread::sleep_for(std::chrono::microseconds(draws_.integer(0, 2000)));
  }
  std::unique_ptr<bus::ports::Exchange> port_;
  RandomStream draws_;
};

TEST(TurnTaking, StopsOfProcessesChangeNothing) {
  const Drive drive = kShort.drive();
  const Lines expected = in_one_process(drive);
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    expect_equal(together(in_processes(drive,
                                       [&](NodeId node, std::unique_ptr<bus::ports::Exchange> port) {
                                         return std::make_unique<Dawdling>(std::move(port), seed, node);
                                       })),
                 expected);
}

// Has its node killed before turn number `turns`, and counts.
class Doomed final : public bus::ports::Exchange {
 public:
  Doomed(std::unique_ptr<bus::ports::Exchange> port, int turns, int& taken)
      : port_(std::move(port)), turns_(turns), taken_(taken) {}
  void send(std::span<const std::byte> message) override {
    if (taken_ == turns_) throw Killed();
    ++taken_;
    port_->send(message);
  }
  Received receive() override { return port_->receive(); }

 private:
  std::unique_ptr<bus::ports::Exchange> port_;
  int turns_;
  int& taken_;
};

std::vector<Lines> with_one_killed(const Drive& drive, std::size_t victim, int turns, std::vector<int>& taken) {
  taken.assign(drive.cluster.nodes.size(), 0);
  return in_processes(drive, [&](NodeId node, std::unique_ptr<bus::ports::Exchange> port) {
    const int most = index_of(node) == victim ? turns : std::numeric_limits<int>::max();
    return std::make_unique<Doomed>(std::move(port), most, taken[index_of(node)]);
  });
}

std::ptrdiff_t slot_problems(const Lines& lines) {
  return std::count_if(lines.begin(), lines.end(),
                       [](const std::string& line) { return line.starts_with("/slot_problem "); });
}

// Killed at the first turn after 100 ms.
TEST(TurnTaking, SurvivorsOfAKilledNodeRecordTheSameUntilThenAndGoOn) {
  Drive until = kShort.drive();
  until.scenario.duration = Duration::milliseconds(100);
  const Drive drive = kShort.drive();
  constexpr int kNeverKilled = std::numeric_limits<int>::max();
  std::vector<int> turns, taken;
  const std::vector<Lines> before = with_one_killed(until, 0, kNeverKilled, turns);
  const std::vector<Lines> whole = with_one_killed(drive, 0, kNeverKilled, taken);
  for (std::size_t victim = 0; victim < before.size(); ++victim) {
    SCOPED_TRACE(drive.cluster.nodes[victim].name);
    const std::vector<Lines> found = with_one_killed(drive, victim, turns[victim], taken);
    for (std::size_t n = 0; n < found.size(); ++n) {
      SCOPED_TRACE(drive.cluster.nodes[n].name);
      ASSERT_GE(found[n].size(), before[n].size());
      EXPECT_TRUE(std::equal(before[n].begin(), before[n].end(), found[n].begin()));
      if (n == victim) {
        EXPECT_LT(found[n].size(), whole[n].size());
      } else if (drive.cluster.nodes[n].flexray && drive.cluster.nodes[victim].flexray) {
        EXPECT_GT(slot_problems(found[n]), slot_problems(whole[n]));
        EXPECT_GT(taken[n], turns[n]);
      }
    }
  }
}

}  // namespace
}  // namespace ttf::sim::processes
