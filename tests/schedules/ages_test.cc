// Ages of a cluster small enough to work out by hand. One cycle is 5 ms, slots last 84 us, oscillators are exact; clocks
// differ by at most 6.85 us (assumed precision) and a macrotick, which with rounding makes 7851 ns on every bound.
//
//   device: measure 1 ms -> list in slot 3 of every cycle (168..252 us)
//   fusion: fuse 2 ms at 1 ms of odd cycles; publish 0.1 ms at the start of even cycles -> image in slot 4 there
//   user:   use at 0.5 ms of even cycles
#include "schedules/ages.h"

#include <gtest/gtest.h>

namespace ttf::schedules {
namespace {

constexpr std::int64_t kClocks = 7851, kApart = 7850, kRounding = 101;

Task timed(std::string name, CycleInstant at, Duration execution) {
  Task task;
  task.name = std::move(name);
  task.activation.at = at;
  task.best_case = task.worst_case = execution;
  return task;
}

Cluster small(bool scheduled) {
  Cluster cluster;
  cluster.pdus.resize(2);
  for (PduLayout& layout : cluster.pdus) {
    layout.fragment_bytes = 56;
    layout.max_elements = layout.elements_per_fragment = 1;
  }
  cluster.pdus[0].sensor = SensorId{0};
  cluster.nodes.resize(3);
  for (Node& node : cluster.nodes) {
    node.flexray.emplace();
    node.drift_ppb = 0;
  }
  Task measure = timed("measure", {}, Duration::milliseconds(1));
  measure.activation.kind = ActivationKind::kSensor;
  measure.activation.sensor = SensorId{0};
  measure.writes = {{"raw", PduId{0}, std::nullopt, 0}};
  cluster.nodes[0].tasks = {measure};
  Task fuse = timed("fuse", {1, 2, Macroticks{1000}}, Duration::milliseconds(2));
  fuse.reads = {{"s", PduId{0}, std::nullopt, 0}};
  Task publish = timed("publish", {0, 2, Macroticks{0}}, Duration::microseconds(100));
  publish.writes = {{"image", PduId{1}, std::nullopt, 0}};
  cluster.nodes[1].tasks = {fuse, publish};
  Task use = timed("use", {0, 2, Macroticks{500}}, Duration::microseconds(100));
  use.reads = {{"image", PduId{1}, std::nullopt, 0}};
  cluster.nodes[2].tasks = {use};
  cluster.frames = {{3, Channels::kAB, 0, 1, NodeId{0}, PduId{0}, 0, 0},
                    {4, Channels::kAB, 0, 2, NodeId{1}, PduId{1}, 0, 0}};
  Sensor sensor;
  sensor.name = "s";
  sensor.scheduled = scheduled;
  sensor.period = Duration::milliseconds(10);
  sensor.at = {0, 2, Macroticks{0}};
  cluster.sensors = {sensor};
  return cluster;
}

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

// BUFF holds until fusion_worst has passed, and then until the next fusion: a period of 10 ms at worst.
TEST(Ages, OfHeldMeasurements) {
  const auto ages = measurement_ages(small(false));
  EXPECT_EQ(ages[0].buffered_fused_worst.ns, ages[0].fusion_worst.ns + 10'000'000 - 1 + kClocks);
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
