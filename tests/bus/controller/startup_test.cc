// Start-up of whole clusters: the leading, following and integrating nodes, the cycle in which each becomes
// active, and failed start-ups.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/random.h"
#include "recording/records/enumerations.h"
#include "tests/bus/alone.h"
#include "tests/bus/startup_cluster.h"

namespace ttf::bus::controller {
namespace {

// The running cycle in which a node became normal active, or -1.
std::int64_t active_in(Rig& rig, std::size_t node) {
  for (const auto& change : rig.reports(node).changed)
    if (change.to == poc::PocKind::kNormalActive) {
      // Cycle starts are reported right after the change.
      const auto& cycles = rig.reports(node).cycle_starts;
      for (const auto& [cycle, at] : cycles)
        if (at == change.at) return cycle;
    }
  return -1;
}

std::vector<poc::PocKind> path(Rig& rig, std::size_t node) {
  std::vector<poc::PocKind> kinds;
  for (const auto& change : rig.reports(node).changed) kinds.push_back(change.to);
  return kinds;
}

TEST(Startup, AllPoweredOnInTimeLeaderInSixFollowersInSevenIntegratorsInEight) {
  Rig rig(startup_cluster(3, 1), {100'000, -200'000, 0, 300'000}, Duration{500},
          {at_ms(1.0), at_ms(1.2), at_ms(1.4), at_ms(1.1)});
  rig.run_until(at_ms(40));
  EXPECT_EQ(active_in(rig, 0), 6);
  EXPECT_EQ(active_in(rig, 1), 7);
  EXPECT_EQ(active_in(rig, 2), 7);
  EXPECT_EQ(active_in(rig, 3), 8);
  using K = poc::PocKind;
  EXPECT_EQ(path(rig, 0), (std::vector<K>{K::kConfig, K::kReady, K::kColdstartListen, K::kColdstartCollisionResolution,
                                          K::kColdstartConsistencyCheck, K::kNormalActive}));
  EXPECT_EQ(path(rig, 1), (std::vector<K>{K::kConfig, K::kReady, K::kColdstartListen, K::kInitialiseSchedule,
                                          K::kIntegrationColdstartCheck, K::kColdstartJoin, K::kNormalActive}));
  EXPECT_EQ(path(rig, 3), (std::vector<K>{K::kConfig, K::kReady, K::kIntegrationListen, K::kInitialiseSchedule,
                                          K::kIntegrationConsistencyCheck, K::kNormalActive}));
  EXPECT_LT(rig.precision(at_ms(40)), Duration{2'000});
  // The absence of the others is the only problem.
  for (std::size_t n = 0; n < 4; ++n)
    for (const auto& problem : rig.reports(n).problems) {
      EXPECT_EQ(problem.status, kNoFrame) << "node " << n;
      EXPECT_LT(problem.cycle, 8) << "node " << n;
    }
}

// In real time, the partner of the first startup frame is handed over on arrival. This may be longer after
// its end than rates can differ.
TEST(Startup, APartnerHandedOverWithinTheMediumsTimeMakesASchedule) {
  struct LatePort final : ports::FlexRayPort {
    void transmit(const ports::Transmission&) override {}
    bool carrier(Channel) const override { return false; }
    Microticks handed_over_within() const override { return within; }
    Microticks within{};
  };
  constexpr std::int64_t kLongest = 9'000, kRateLimit = 121;  // of 40'000 a cycle
  const auto state_after = [](std::int64_t within, std::int64_t late) {
    const schedules::model::Cluster cluster = startup_cluster(1, 1);
    LatePort port;
    port.within = {within};
    Reports reports;
    FlexRayController controller(cluster, NodeId{1}, port, reports);
    controller.start_cold({0});
    for (const int cycle : {4, 5}) {
      Frame frame = Frame::status(1, cycle);
      const auto bytes = frame.bytes();
      controller.advance({frame.start + frame.length + (cycle == 5 ? late : 0)});
      controller.receive(received(Channel::kA, {frame.start}, {frame.start + frame.length}, bytes));
    }
    return controller.state().kind;
  };
  EXPECT_EQ(state_after(0, 0), poc::PocKind::kIntegrationConsistencyCheck);
  EXPECT_EQ(state_after(0, kRateLimit + 1), poc::PocKind::kIntegrationListen) << "the odd frame begins nothing";
  EXPECT_EQ(state_after(kLongest, kLongest), poc::PocKind::kIntegrationConsistencyCheck);
  EXPECT_EQ(state_after(kLongest, kLongest + kRateLimit + 1), poc::PocKind::kIntegrationListen);
}

TEST(Startup, OneColdstartNodeAloneUsesUpItsAttempts) {
  Rig rig(startup_cluster(1, 1), {0, 0}, Duration{500}, {at_ms(1.0), at_ms(1.0)});
  rig.run_until(at_ms(500));
  EXPECT_EQ(active_in(rig, 0), -1);
  EXPECT_EQ(rig.controller(0).state().kind, poc::PocKind::kIntegrationListen);
  EXPECT_EQ(rig.reports(0).changed.back().consequence, poc::PocReason::kAttemptsExhausted);
  const auto attempts =
      std::count_if(rig.reports(0).changed.begin(), rig.reports(0).changed.end(),
                    [](const auto& change) { return change.to == poc::PocKind::kColdstartCollisionResolution; });
  EXPECT_EQ(attempts, rig.cluster().flexray.gColdStartAttempts);
}

TEST(Startup, TwoThatBeginAtTheSameInstantSortThemselvesOut) {
  Rig rig(startup_cluster(2), {0, 0}, Duration{500}, {at_ms(1.0), at_ms(1.0)});
  rig.run_until(at_ms(60));
  EXPECT_EQ(rig.controller(0).state().kind, poc::PocKind::kNormalActive);
  EXPECT_EQ(rig.controller(1).state().kind, poc::PocKind::kNormalActive);
}

TEST(Startup, ALateNodeIntegratesIntoTheRunningCluster) {
  for (const bool coldstart : {true, false}) {
    Rig rig(startup_cluster(coldstart ? 3 : 2, coldstart ? 0 : 1), {0, 100'000, -300'000}, Duration{500},
            {at_ms(1.0), at_ms(1.1), at_ms(103.7)});
    rig.run_until(at_ms(140));
    ASSERT_EQ(rig.controller(2).state().kind, poc::PocKind::kNormalActive) << coldstart;
    EXPECT_LT(rig.reports(2).changed.back().at, Microticks{40'000 * 120});
    // Its cycle counter is the cluster's; how often that has wrapped it cannot count.
    EXPECT_EQ(rig.controller(2).clock()->cycle() % 64, rig.controller(0).clock()->cycle() % 64);
    for (std::size_t n = 0; n < 3; ++n)
      EXPECT_TRUE(std::all_of(rig.reports(n).problems.begin(), rig.reports(n).problems.end(),
                              [](const auto& problem) { return problem.status == kNoFrame && problem.slot == 3; }))
          << "node " << n;
  }
}

TEST(Startup, ARestartedNodeComesBack) {
  Rig rig(startup_cluster(3), {0, 100'000, -100'000}, Duration{500}, {at_ms(1.0), at_ms(1.1), at_ms(1.2)});
  rig.run_until(at_ms(50));
  rig.power_on(2, at_ms(50.3));  // out of the middle of a cycle
  rig.run_until(at_ms(90));
  EXPECT_EQ(rig.controller(2).state().kind, poc::PocKind::kNormalActive);
  EXPECT_EQ(rig.controller(0).state().kind, poc::PocKind::kNormalActive);
}

TEST(Startup, NoiseDelaysTheColdstartUntilTheNoiseTimerExpires) {
  Rig rig(startup_cluster(2), {0, 0}, Duration{500}, {at_ms(1.0), at_ms(1.0)});
  // Noise on channel A until 9 ms, always repeated before a listen time-out of 2 ms is over.
  for (int i = 0; i < 9; ++i)
    for (const std::size_t node : {0u, 1u})
      rig.medium().put({at_ms(1.5 + i * 0.9),
                        at_ms(1.6 + i * 0.9),
                        schedules::model::Channel::kA,
                        9,
                        node,
                        ports::Signal::kUndecodable,
                        {}});
  rig.run_until(at_ms(60));
  EXPECT_EQ(rig.controller(0).state().kind, poc::PocKind::kNormalActive);
  const auto lead = std::find_if(rig.reports(0).changed.begin(), rig.reports(0).changed.end(), [](const auto& change) {
    return change.to == poc::PocKind::kColdstartCollisionResolution;
  });
  ASSERT_NE(lead, rig.reports(0).changed.end());
  EXPECT_EQ(lead->reason, poc::PocReason::kColdstartAfterNoise);
  // gListenNoise 2 times 2 ms after 1 ms; without the noise, 3 ms.
  EXPECT_NEAR(static_cast<double>(lead->at.value) * 25e-6, 5.0, 0.1);
}

TEST(Startup, TheLoserOfACollisionFollowsTheWinner) {
  // Node 1 sends its CAS while node 0's is already on its way.
  int collisions = 0;
  for (int tick = 0; tick < 40; ++tick) {
    Rig rig(startup_cluster(3), {0, 0, 0}, Duration{700}, {at_ms(1.0), at_ms(1.0) + Duration{tick * 25}, at_ms(1.0)});
    rig.run_until(at_ms(60));
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_EQ(rig.controller(n).state().kind, poc::PocKind::kNormalActive) << "tick " << tick << " node " << n;
      for (const auto& change : rig.reports(n).changed)
        if (change.reason == poc::PocReason::kCollisionHeader || change.reason == poc::PocReason::kCollisionCas)
          ++collisions;
    }
    const auto leaders = [&] {
      int count = 0;
      for (std::size_t n = 0; n < 3; ++n)
        for (const auto& change : rig.reports(n).changed) count += change.reason == poc::PocReason::kClusterStarted;
      return count;
    }();
    EXPECT_EQ(leaders, 1) << "tick " << tick;
  }
  EXPECT_GT(collisions, 0);
}

TEST(Startup, RandomPowerOnDelaysWithinTheAttempts) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    RandomStream draw({seed, 0, Purpose::kTest, 0, 0});
    const int coldstart = static_cast<int>(draw.integer(2, 4)), others = static_cast<int>(draw.integer(0, 2));
    std::vector<std::int64_t> drifts;
    std::vector<TrueTime> power_on;
    for (int n = 0; n < coldstart + others; ++n) {
      drifts.push_back(draw.integer(-1'500'000, 1'500'000));
      power_on.push_back(TrueTime{draw.integer(0, 20'000'000)});
    }
    Rig rig(startup_cluster(coldstart, others), drifts, Duration{draw.integer(0, 2'500)}, power_on);
    rig.run_until(at_ms(100));
    for (std::size_t n = 0; n < drifts.size(); ++n)
      ASSERT_EQ(rig.controller(n).state().kind, poc::PocKind::kNormalActive)
          << "seed " << seed << " node " << n << ": " << to_text(rig.controller(n).state().kind) << ", "
          << to_text(rig.reports(n).changed.back().reason);
    ASSERT_LT(rig.precision(at_ms(100)), Duration{6'850}) << "seed " << seed;  // the assumed precision of the layout
  }
}

}  // namespace
}  // namespace ttf::bus::controller
