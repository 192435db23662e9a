// Whole drives in a closed loop. No picture takes longer to its first command than its chain's bound. An exact chain
// takes as long.
#include "schedules/analysis/chain/chains.h"

#include <gtest/gtest.h>

#include <string>

#include "schedules/check/checker.h"
#include "tests/sim/drives/ages/followed_chains.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives::ages {
namespace {

using fusion::strategies::StrategyKind;
using schedules::analysis::chain::Chain;

void expect_within(const Drive& drive, std::uint64_t seed) {
  FollowedChains followed(drive.cluster, evaluation_start(drive.scenario));
  drive.run(followed, seed);
  const bool held = drive.strategy == StrategyKind::kBuff;
  for (const Chain& chain : schedules::analysis::chain::chains(drive.cluster)) {
    SCOPED_TRACE(chain.name + ", " + std::string(name_of(drive.strategy)) + ", seed " + std::to_string(seed));
    const bool holds = held && chain.fused;
    const FollowedChains::Seen& seen = followed.seen(chain.command, chain.sensor);
    EXPECT_GT(seen.pictures, 10u);
    EXPECT_GT(seen.readings, 20u);
    EXPECT_GE(seen.first_least, chain.reduced_reaction_best());
    EXPECT_LE(seen.first_most, chain.reduced_reaction_worst(holds));
    EXPECT_LE(seen.age_most, chain.reduced_age_worst(holds));
    EXPECT_LE(seen.age_until_next_most, chain.age_worst(holds));
    if (!chain.exact || holds) continue;
    // Only the clocks differ.
    const schedules::analysis::Contribution& clocks = chain.path.to_use.back();
    EXPECT_GT(seen.first_most, chain.reduced_reaction_worst() - (clocks.worst - clocks.best));
    EXPECT_GT(seen.age_until_next_most, chain.age_worst() - (clocks.worst - clocks.best) - Duration::microseconds(50));
  }
}

Drive driving(StrategyKind kind, std::int64_t ms) {
  Drive drive("scenarios/acc_braking_lead.yaml", kind);
  drive.scenario.duration = Duration::milliseconds(ms);
  return drive;
}

TEST(ChainsOfDrives, AreWithinTheirBounds) {
  for (const StrategyKind kind : fusion::strategies::kAllStrategies) expect_within(driving(kind, 3'500), 1);
}

// The vehicle brakes. Processing times are drawn otherwise. Every CAN has other traffic.
TEST(ChainsOfDrives, AreWithinTheirBoundsForAllDrawsAndUnderLoad) {
  for (const StrategyKind kind : fusion::strategies::kAllStrategies)
    for (std::uint64_t seed = 2; seed < 8; ++seed) {
      Drive drive = driving(kind, 9'000);
      if (seed % 2 == 0)
        for (schedules::model::CanBus& bus : drive.cluster.can_buses) bus.other_load = 0.1;
      EXPECT_EQ(schedules::check::check(drive.cluster).size(), 0u);
      expect_within(drive, seed);
    }
}

}  // namespace
}  // namespace ttf::sim::drives::ages
