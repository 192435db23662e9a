// Clock synchronisation under random clocks, delays and Byzantine sync nodes. FlexRay's fault-tolerant
// midpoint drops one value at each end of 3 to 7, and two of 8 to 15. So one arbitrary clock among 4 to 7 and
// two among 8 to 15 do no harm; one of 3 and two of 7 do.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "core/random.h"
#include "sim/engine/bus_simulation.h"
#include "tests/sim/engine/bus_clusters.h"

namespace ttf::sim::engine {
namespace {

// The sync frames of nodes 0..traitors-1 reach each receiver at a different time: late at some, early at
// others, still inside the slot. This is the worst that a clock can do unnoticed.
class TwoFaced final : public medium::Disturbance {
 public:
  // Pull apart: late at every other receiver, early at the rest. Pull rates: also inverted in every other
  // cycle, so that double cycles seem long to some and short to others.
  enum class Plan { kRandom, kPullApart, kPullRates };
  TwoFaced(int traitors, Plan plan, std::uint64_t seed) : traitors_(traitors), plan_(plan), seed_(seed) {}
  bool leaving(medium::Leaving& signal) override {
    if (signal.channel == schedules::model::Channel::kA) ++sent_[index_of(signal.sender)];
    return true;
  }
  bool arriving(medium::Arriving& signal) override {
    if (static_cast<int>(index_of(signal.sender)) >= traitors_ || signal.signal != bus::ports::Signal::kFrame)
      return true;
    const std::int64_t ns = lie(signal);
    signal.start = signal.start + Duration{ns};
    signal.end = signal.end + Duration{ns};
    return true;
  }

 private:
  std::int64_t lie(const medium::Arriving& signal) {
    const auto receiver = static_cast<std::int64_t>(index_of(signal.receiver));
    const std::int64_t pull = receiver % 2 == 0 ? kMost : -kMost;
    if (plan_ == Plan::kPullApart) return pull;
    if (plan_ == Plan::kPullRates) return sent_[index_of(signal.sender)] % 2 == 0 ? pull : -pull;
    RandomStream draw({seed_, static_cast<std::uint32_t>(receiver), Purpose::kTest, 0, calls_++});
    return draw.integer(-kMost, kMost);
  }
  static constexpr std::int64_t kMost = 5'500;  // of 7 us before the action point
  int traitors_;
  Plan plan_;
  std::uint64_t seed_;
  std::uint32_t calls_ = 0;
  std::array<std::uint32_t, 15> sent_{};
};

struct Outcome {
  Duration worst{};
  bool all_active = true;  // the honest ones
};

Outcome run(int sync, int traitors, TwoFaced::Plan plan, std::uint64_t seed, Duration length) {
  const schedules::model::Cluster cluster = bus_cluster(sync, std::min(sync, 3), sync);
  std::vector<BusNode> nodes;
  std::vector<std::unique_ptr<StateLog>> logs;
  std::vector<bus::controller::ControllerEvents*> events;
  for (int n = 0; n < sync; ++n) {
    RandomStream draw({seed, 0, Purpose::kClockDrift, static_cast<std::uint16_t>(n), 0});
    nodes.push_back({timebase::Oscillator{25'000, draw.integer(-1'500'000, 1'500'000), draw.integer(0, 24'999)},
                     TrueTime{draw.integer(0, 9'000'000)}});
    logs.push_back(std::make_unique<StateLog>());
    events.push_back(logs.back().get());
  }
  BusSimulation simulation(cluster, std::move(nodes), std::move(events));
  simulation.run_until(TrueTime{100'000'000});
  TwoFaced two_faced(traitors, plan, seed);
  simulation.set_disturbance(&two_faced);
  Outcome outcome;
  for (TrueTime at{101'000'000}; at < TrueTime{100'000'000} + length; at = at + Duration{711'000}) {
    simulation.run_until(at);
    outcome.worst = std::max(outcome.worst, simulation.precision(static_cast<NodeId>(traitors)));
  }
  for (int n = traitors; n < sync; ++n)
    outcome.all_active &=
        simulation.controller(static_cast<NodeId>(n)).state().kind == bus::poc::PocKind::kNormalActive;
  return outcome;
}

TEST(ClockSynchronisation, WithoutFaultsThePrecisionHoldsForRandomClocks) {
  for (int sync = 2; sync <= 15; ++sync)
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const Outcome outcome = run(sync, 0, TwoFaced::Plan::kRandom, seed, Duration::milliseconds(400));
      EXPECT_TRUE(outcome.all_active) << sync << " sync nodes, seed " << seed;
      EXPECT_LE(outcome.worst.ns, kAssumedPrecision.ns) << sync << " sync nodes, seed " << seed;
    }
}

class Tolerated : public testing::TestWithParam<int> {};

TEST_P(Tolerated, ByzantineClocksDoNoHarm) {
  const int sync = GetParam(), traitors = sync < 8 ? 1 : 2;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const auto plan : {TwoFaced::Plan::kRandom, TwoFaced::Plan::kPullApart, TwoFaced::Plan::kPullRates}) {
      const Outcome outcome = run(sync, traitors, plan, seed, Duration::milliseconds(600));
      EXPECT_TRUE(outcome.all_active) << "seed " << seed;
      EXPECT_LE(outcome.worst.ns, kAssumedPrecision.ns) << "seed " << seed << " plan " << static_cast<int>(plan);
    }
}

INSTANTIATE_TEST_SUITE_P(SyncNodes, Tolerated, testing::Range(4, 16));

TEST(ClockSynchronisation, OneOfThreeAndTwoOfSevenBreakThePrecision) {
  for (const auto& [sync, traitors] : {std::pair{3, 1}, std::pair{7, 2}}) {
    Duration worst{};
    for (std::uint64_t seed = 0; seed < 10; ++seed)
      worst = std::max(worst, run(sync, traitors, TwoFaced::Plan::kPullRates, seed, Duration::milliseconds(600)).worst);
    EXPECT_GT(worst.ns, kAssumedPrecision.ns) << traitors << " of " << sync;
  }
}

}  // namespace
}  // namespace ttf::sim::engine
