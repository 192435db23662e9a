// A guardian that has lost its cluster starts anew as often as needed, without allocation, and then works as
// before.
#include <gtest/gtest.h>

#include "tests/sim/engine/guarded.h"
#include "tests/support/allocation_counter.h"

namespace ttf::sim::engine {
namespace {

using bus::poc::PocKind;
using schedules::model::Channel;

const timebase::Oscillator kFastGuardian{25'000, 1'000'000, 0};

TEST(GuardianRestart, AGuardianThatReceivesNothingBeginsAnewWithoutAllocating) {
  const schedules::model::Cluster cluster = star_cluster(4, 2, 3);
  medium::StarCoupler coupler(cluster, Channel::kA, kFastGuardian);
  const TrueTime first{1'000'000};
  for (int round = 0; round < 20; ++round) {
    const TrueTime begin = first + cluster.cycle() * (100 * round);
    const std::int64_t before = support::allocations();
    coupler.start_integrated(begin, cluster.cycle());
    ASSERT_EQ(coupler.state().kind, PocKind::kNormalActive);
    coupler.catch_up(begin + cluster.cycle() * 50);
    EXPECT_EQ(coupler.state().kind, PocKind::kIntegrationListen);
    EXPECT_FALSE(coupler.clock().has_value());
    EXPECT_EQ(support::allocations(), before) << "round " << round;
  }
}

TEST(GuardianRestart, AClusterThatWentAwayStartsAgainBehindTheSameGuardians) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Guarded cluster(star_cluster(5, 3, 4), seed, Duration::milliseconds(9));
    for (int time = 0; time < 3; ++time) {
      cluster.run_cycles(30);
      ASSERT_TRUE(cluster.all_active()) << "seed " << seed << ", time " << time;
      for (const Channel channel : kBothChannels) {
        cluster.coupler(channel).catch_up(cluster.simulation->now());
        ASSERT_EQ(cluster.coupler(channel).state().kind, PocKind::kNormalActive);
      }
      for (std::size_t n = 0; n < cluster.logs.size(); ++n) cluster.simulation->power_off(static_cast<NodeId>(n));
      cluster.run_cycles(20);
      for (const Channel channel : kBothChannels) {
        cluster.coupler(channel).catch_up(cluster.simulation->now());
        ASSERT_EQ(cluster.coupler(channel).state().kind, PocKind::kIntegrationListen);
      }
      for (std::size_t n = 0; n < cluster.logs.size(); ++n)
        cluster.simulation->power_on(static_cast<NodeId>(n),
                                     cluster.simulation->now() + Duration::milliseconds(static_cast<std::int64_t>(n)));
    }
  }
}

}  // namespace
}  // namespace ttf::sim::engine
