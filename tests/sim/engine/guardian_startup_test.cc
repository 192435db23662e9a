// Clusters start through the guardians in the specification's cycles, from any power-on delays, with one
// coldstart node in any kind of madness.
#include <gtest/gtest.h>

#include "tests/sim/engine/guarded.h"
#include "tests/sim/engine/start_spoiler.h"

namespace ttf::sim::engine {
namespace {

using bus::poc::PocKind;
using bus::poc::PocReason;
using schedules::model::Channel;

bool guardians_synchronised(Guarded& started) {
  return std::all_of(kBothChannels.begin(), kBothChannels.end(), [&](Channel channel) {
    started.coupler(channel).catch_up(started.simulation->now());
    return started.coupler(channel).state().kind == PocKind::kNormalActive;
  });
}

// All powered on within a few cycles: the first to listen leads, and the guardians integrate like the last
// nodes.
TEST(GuardianStartup, TheCyclesOfTheSpecification) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Guarded started(star_cluster(5, 3, 5), seed, Duration::milliseconds(9));
    started.run_cycles(20);
    std::map<std::int64_t, int> active_in;
    for (const auto& log : started.logs) ++active_in[log->states.active_in()];
    EXPECT_EQ(active_in, (std::map<std::int64_t, int>{{6, 1}, {7, 2}, {8, 2}})) << "seed " << seed;
    EXPECT_TRUE(guardians_synchronised(started)) << "seed " << seed;
    started.forget();
    started.run_cycles(60);
    EXPECT_LE(started.simulation->precision(), kAssumedPrecision) << "seed " << seed;
    EXPECT_EQ(started.problems(), 0u) << "seed " << seed;
    EXPECT_TRUE(started.none_left_active()) << "seed " << seed;
  }
}

// Simultaneous symbols of several nodes: the coupler's first one leads.
TEST(GuardianStartup, OfNodesThatBeginTogetherOneLeads) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Guarded started(star_cluster(4, 4, 4), seed);
    started.run_cycles(25);
    int leaders = 0;
    for (const auto& log : started.logs)
      for (const auto& change : log->states.changes) leaders += change.reason == PocReason::kClusterStarted;
    EXPECT_EQ(leaders, 1) << "seed " << seed;
    EXPECT_TRUE(started.all_active() && guardians_synchronised(started)) << "seed " << seed;
  }
}

struct GuardedSize {
  int nodes, coldstart, sync, runs;
};
class GuardedConformance : public testing::TestWithParam<GuardedSize> {};

// The same window as without guardians (startup_conformance_test.cc): six of eight attempts of six cycles.
TEST_P(GuardedConformance, StartsFromAnyPowerOnDelaysWithinTheAttempts) {
  const GuardedSize size = GetParam();
  const Duration window = Duration::milliseconds(6 * 5 * 6);
  for (int run = 0; run < size.runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    Guarded started(star_cluster(size.nodes, size.coldstart, size.sync), seed, window);
    started.run(window + Duration::milliseconds(150));
    ASSERT_TRUE(started.all_active()) << "run " << run;
    EXPECT_TRUE(guardians_synchronised(started)) << "run " << run;
    EXPECT_LE(started.simulation->precision(), kAssumedPrecision) << "run " << run;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, GuardedConformance,
                         testing::Values(GuardedSize{2, 2, 2, 1000}, GuardedSize{4, 3, 4, 1000},
                                         GuardedSize{16, 4, 8, 200}, GuardedSize{64, 5, 15, 10}),
                         [](const auto& name) { return std::to_string(name.param.nodes) + "Nodes"; });

TEST(GuardianStartup, ARestartedNodeIntegratesAgain) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Guarded started(star_cluster(5, 3, 4), seed, Duration::milliseconds(9));
    started.run_cycles(20);
    const auto node = static_cast<NodeId>(seed % 5);
    started.simulation->power_off(node);
    started.run(Duration{100'000'000 + static_cast<std::int64_t>(seed) * 123'457});
    started.simulation->power_on(node, started.simulation->now() + Duration{1});
    started.run_cycles(16);
    EXPECT_TRUE(started.all_active()) << "seed " << seed;
  }
}

// All nodes lose the supply, and the guardians lose their schedule with the cluster: it must not block the
// next start.
TEST(GuardianStartup, AClusterThatWentDownStartsAgain) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Guarded started(star_cluster(5, 3, 4), seed, Duration::milliseconds(9));
    started.run_cycles(20);
    ASSERT_TRUE(guardians_synchronised(started));
    RandomStream draw({seed, 0, Purpose::kTest, 3, 0});
    for (std::size_t n = 0; n < 5; ++n)
      started.simulation->power_on(static_cast<NodeId>(n),
                                   started.simulation->now() + Duration{draw.integer(1, 20'000'000)});
    started.run_cycles(45);
    EXPECT_TRUE(started.all_active()) << "seed " << seed;
    EXPECT_TRUE(guardians_synchronised(started)) << "seed " << seed;
  }
}

// A cluster that runs already, on the other channel.
TEST(GuardianStartup, AGuardianThatComesLateJoinsTheRunningCluster) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Guarded started(star_cluster(5, 3, 4), seed, Duration::milliseconds(9));
    started.coupler(Channel::kB).fail(medium::StarCoupler::Failure::kSilent);
    started.run(Duration{120'000'000 + static_cast<std::int64_t>(seed) * 1'234'567});
    ASSERT_TRUE(started.all_active());
    started.coupler(Channel::kB).fail(medium::StarCoupler::Failure::kNone);
    started.run_cycles(14);
    EXPECT_TRUE(guardians_synchronised(started)) << "seed " << seed;
    started.forget();
    started.run_cycles(20);
    EXPECT_EQ(started.problems(), 0u) << "seed " << seed;
    EXPECT_TRUE(started.none_left_active()) << "seed " << seed;
  }
}

// ---- one coldstart node gone mad

constexpr Duration kPoweredOnWithin = Duration::milliseconds(20);  // four cycles

// Cycles until all fault-free nodes are active, `most` if they are not by then.
struct Spoiled {
  Guarded started;
  StartSpoiler spoiler;
  Spoiled(int good_coldstart_nodes, bool guardian, StartSpoiler::Plan plan, std::uint64_t seed)
      : started(star_cluster(5, 1 + good_coldstart_nodes, 5, guardian), power_on(seed), seed),
        spoiler(*started.simulation, started.cluster, plan, seed) {
    started.simulation->set_disturbance(&spoiler);
  }
  static std::vector<TrueTime> power_on(std::uint64_t seed) {
    auto at = Guarded::delays(5, kPoweredOnWithin, seed);
    at[0] = TrueTime{1'000'000'000'000};
    return at;
  }
  int start(int most) {
    int cycles = 0;
    while (cycles < most && !started.all_active(1)) started.run_cycles(1), ++cycles;
    return cycles;
  }
};

class SpoiledStart : public testing::TestWithParam<StartSpoiler::Plan> {};

TEST_P(SpoiledStart, TwoFaultFreeColdstartNodesStartTheClusterAllTheSame) {
  constexpr int kMost = 40;  // cycles; without a mad node it takes 15
  for (const int good : {2, 3})
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      Spoiled spoiled(good, true, GetParam(), seed);
      ASSERT_LT(spoiled.start(kMost), kMost) << good << " coldstart nodes, seed " << seed;
      // And once started, it stays so.
      spoiled.started.run_cycles(10);  // the second guardian
      spoiled.started.forget();
      spoiled.started.run_cycles(30);
      EXPECT_TRUE(spoiled.started.none_left_active(1)) << good << " coldstart nodes, seed " << seed;
      EXPECT_LE(spoiled.started.simulation->precision(NodeId{1}), kAssumedPrecision);
    }
}

INSTANTIATE_TEST_SUITE_P(Plans, SpoiledStart, testing::ValuesIn(StartSpoiler::kPlans));

// The guardians' purpose: on a star without them, and on a bus, one node keeps all others from starting.
TEST(GuardianStartup, WithoutGuardiansOneNodePreventsTheStart) {
  for (const auto plan : {StartSpoiler::Plan::kBabble, StartSpoiler::Plan::kSymbols, StartSpoiler::Plan::kEvenCycles,
                          StartSpoiler::Plan::kMasquerade})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      Spoiled spoiled(2, false, plan, seed);
      EXPECT_EQ(spoiled.start(200), 200) << "plan " << static_cast<int>(plan) << ", seed " << seed;
    }
}

}  // namespace
}  // namespace ttf::sim::engine
