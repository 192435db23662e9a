// Ages of a cluster small enough to work out by hand, tests/schedules/small_cluster.h.
#include "schedules/ages.h"

#include <gtest/gtest.h>

#include "tests/schedules/small_cluster.h"

namespace ttf::schedules {
namespace {

// Measured at 0, written at 1 ms, sent in the next cycle's slot 3: at worst until its end, 5.252 ms; at best the frame's 652
// bits from the action point on, 5.175 ms + 65.2 us. Fused at 6 ms, published at 10 ms, used at 10.5 ms.
TEST(Ages, OfAScheduledSensorAreExact) {
  const auto ages = measurement_ages(small(true));
  ASSERT_EQ(ages.size(), 1u);
  EXPECT_EQ(ages[0].fusion_best.ns, 5'240'200 - kClocks);
  EXPECT_EQ(ages[0].fusion_worst.ns, 5'252'000 + kClocks);
  EXPECT_EQ(ages[0].fused_best.ns, 6'000'000 - kClocks);
  EXPECT_EQ(ages[0].fused_worst.ns, 6'000'000 + kClocks);
  ASSERT_TRUE(ages[0].reaches_use);
  EXPECT_EQ(ages[0].use_best.ns, 10'500'000 - kClocks);
  EXPECT_EQ(ages[0].use_worst.ns, 10'500'000 + kClocks);
  // Every use has a newer measurement than the one before.
  EXPECT_EQ(ages[0].newest_worst.ns, ages[0].use_worst.ns + kApart);
}

// Adverse phase: written just after slot 3 of cycle c has begun at 168 us, so sent in cycle c + 1. If that is even, the list
// is fused in c + 2 and used in c + 3, 15.332 ms after it was written; if odd, 5 ms earlier.
TEST(Ages, OfAFreeSensorAreTheAdversePhases) {
  const auto ages = measurement_ages(small(false));
  ASSERT_EQ(ages.size(), 1u);
  EXPECT_EQ(ages[0].fusion_best.ns, 1'000'000 - kRounding + 65'200 - kClocks);
  EXPECT_EQ(ages[0].fusion_worst.ns, 1'000'000 + kRounding + 5'084'000 - 1 + kClocks);
  EXPECT_EQ(ages[0].use_worst.ns, 1'000'000 + kRounding + 15'332'000 - 1 + kClocks);
  // Written at the action point of slot 3 of an odd cycle (175 us): fused in it, used 0.5 ms into the next.
  EXPECT_EQ(ages[0].use_best.ns, 1'000'000 - kRounding + 5'500'000 - 175'000 - kClocks);
}

TEST(Ages, ContributionsComeInTheOrderOfTheWay) {
  const auto ages = measurement_ages(small(false));
  ASSERT_EQ(ages[0].to_fusion.size(), 3u);
  EXPECT_NE(ages[0].to_fusion[0].name.find("measure executes"), std::string::npos);
  EXPECT_NE(ages[0].to_fusion[1].name.find("slots"), std::string::npos);
  EXPECT_NE(ages[0].to_fusion[2].name.find("clocks"), std::string::npos);
  Duration best{}, worst{};
  for (const Contribution& part : ages[0].to_fusion) best += part.best, worst += part.worst;
  EXPECT_EQ(best, ages[0].fusion_best);
  EXPECT_EQ(worst, ages[0].fusion_worst);
}

// Sent within the clocks' distance before the fusion begins: at worst it misses it, at best it does not.
TEST(Ages, ClocksThatDifferCountAtCloseInstants) {
  Cluster cluster = small(true);
  cluster.nodes[1].tasks[0].activation.at.offset = Macroticks{255};   // slot 3 ends at 252 us
  const auto ages = measurement_ages(cluster);
  EXPECT_EQ(ages[0].fused_best.ns, 5'255'000 - kClocks);
  EXPECT_EQ(ages[0].fused_worst.ns, 15'255'000 + kClocks);
}

// Two of a node's tasks are activated by messages: each may have to wait for the other.
TEST(Ages, ATaskInTheWayCountsOnce) {
  Cluster cluster = small(false);
  Task other = timed("other", {}, Duration::milliseconds(3));
  other.activation.kind = ActivationKind::kMessage;
  cluster.nodes[2].tasks.push_back(other);
  const auto plain = measurement_ages(small(false)), delayed = measurement_ages(cluster);
  EXPECT_EQ(delayed[0].use_best, plain[0].use_best);
  EXPECT_EQ(delayed[0].use_worst.ns - plain[0].use_worst.ns, 3'000'000 + kRounding);
}

// Written when slot 3 of an odd cycle begins at the latest, a list is fused in that cycle at 1 ms; written later, 10 ms
// later. So BUFF holds no list longer than the way to the slot, 0.832 ms from there to the fusion and the 10 ms; a stamp
// may be 1.5 us off.
TEST(Ages, OfHeldMeasurements) {
  const auto ages = measurement_ages(small(false));
  EXPECT_EQ(ages[0].buffered_fused_worst.ns,
            1'000'000 + kRounding + kApart + 1'500 + 832'000 + 10'000'000 + kClocks);
  EXPECT_EQ(ages[0].buffered_use_worst.ns, ages[0].buffered_fused_worst.ns + 4'500'000);
  EXPECT_EQ(ages[0].buffered_newest_worst - ages[0].buffered_use_worst, ages[0].newest_worst - ages[0].use_worst);
}

TEST(Ages, ASensorNobodyFusesIsLeftOut) {
  Cluster cluster = small(true);
  cluster.nodes[1].tasks[0].reads.clear();
  EXPECT_TRUE(measurement_ages(cluster).empty());
}

}  // namespace
}  // namespace ttf::schedules
