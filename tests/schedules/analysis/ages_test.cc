// Ages of a cluster small enough to work out by hand, tests/schedules/small_cluster.h.
#include "schedules/analysis/ages.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "schedules/analysis/can_load.h"
#include "tests/schedules/cluster_file.h"
#include "tests/schedules/small_cluster.h"

namespace ttf::schedules::analysis {
namespace {

// Measured at 0, written at 1 ms, sent in the next cycle's slot 3. At worst it is complete at the slot's end,
// 5.252 ms. At best it takes the frame's 652 bits from the action point on, 5.175 ms + 65.2 us. Fused at 6
// ms, published at 10 ms, used at 10.5 ms.
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

// Adverse phase: written just after slot 3 of cycle c has begun at 168 us, so sent in cycle c + 1. If that is
// even, the list is fused in c + 2 and used in c + 3, 15.332 ms after it was written. If odd, 5 ms earlier.
TEST(Ages, OfAFreeSensorAreTheAdversePhases) {
  const auto ages = measurement_ages(small(false));
  ASSERT_EQ(ages.size(), 1u);
  EXPECT_EQ(ages[0].fusion_best.ns, 1'000'000 - kRounding + 65'200 - kClocks);
  EXPECT_EQ(ages[0].fusion_worst.ns, 1'000'000 + kRounding + 5'084'000 - 1 + kClocks);
  EXPECT_EQ(ages[0].use_worst.ns, 1'000'000 + kRounding + 15'332'000 - 1 + kClocks);
  // Written at the action point of slot 3 of an odd cycle (175 us): fused in it, used 0.5 ms into the next.
  EXPECT_EQ(ages[0].use_best.ns, 1'000'000 - kRounding + 5'500'000 - 175'000 - kClocks);
}

// Oscillators are 1500 ppm off to either side. 3000 ppm count for the execution and for the wait on the grid,
// the execution's once only.
TEST(Ages, DriftCountsOnceOnEachStretch) {
  model::Cluster cluster = small(false);
  for (model::Node& node : cluster.nodes) node.drift_ppb = 1'500'000;
  const auto ages = measurement_ages(cluster);
  EXPECT_EQ(ages[0].fusion_worst.ns, 1'000'000 + 3'001 + kRounding + 5'084'000 - 1 + kApart + 15'251);
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

// The list is sent within the clocks' distance before the fusion begins: at worst it misses the fusion, at
// best not.
TEST(Ages, ClocksThatDifferCountAtCloseInstants) {
  model::Cluster cluster = small(true);
  cluster.nodes[1].tasks[0].activation.at.offset = Macroticks{255};  // slot 3 ends at 252 us
  const auto ages = measurement_ages(cluster);
  EXPECT_EQ(ages[0].fused_best.ns, 5'255'000 - kClocks);
  EXPECT_EQ(ages[0].fused_worst.ns, 15'255'000 + kClocks);
}

// Messages activate two of a node's tasks: each may have to wait for the other.
TEST(Ages, ATaskInTheWayCountsOnce) {
  model::Cluster cluster = small(false);
  model::Task other = timed("other", {}, Duration::milliseconds(3));
  other.activation.kind = model::ActivationKind::kMessage;
  cluster.nodes[2].tasks.push_back(other);
  const auto plain = measurement_ages(small(false)), delayed = measurement_ages(cluster);
  EXPECT_EQ(delayed[0].use_best, plain[0].use_best);
  EXPECT_EQ(delayed[0].use_worst.ns - plain[0].use_worst.ns, 3'000'000 + kRounding);
}

// The gateway's tasks read lists that come over one CAN, the laser's before the camera's. The laser's list
// took nine frames since the camera's last one, so only the rest of the camera's execution remains. The other
// way round it is one frame.
TEST(Ages, ListsOnOneCanComeOneAfterTheOther) {
  model::Cluster cluster = file::load_cluster(shipped_path("paper_unsynchronised"));
  const auto waits = [&](const std::string& sensor) {
    for (const AgePath& path : measurement_ages(cluster))
      if (cluster.sensor(path.sensor).name == sensor)
        for (const Contribution& part : path.to_fusion)
          if (part.name.find("waits for other tasks") != std::string::npos) return part.worst;
    return Duration{};
  };
  const model::CanBus bus = *std::find_if(cluster.can_buses.begin(), cluster.can_buses.end(),
                                          [](const model::CanBus& b) { return b.name == "observation_can"; });
  const Duration frame = can_worst_case(bus, 56);
  const Duration unsure = Duration::microseconds(20);  // 3000 ppm and rounding
  ASSERT_GT(Duration::microseconds(200), frame);
  EXPECT_EQ(waits("laser"), Duration{});
  EXPECT_GT(waits("camera"), Duration::microseconds(200) - frame);
  EXPECT_LT(waits("camera"), Duration::microseconds(200) - frame + unsure);
  const NodeId gateway = *cluster.find_node("gateway");
  for (model::Task& task : cluster.nodes[index_of(gateway)].tasks) task.worst_case = Duration::milliseconds(3);
  EXPECT_GT(waits("laser"), Duration::milliseconds(3) - frame * 9);
  EXPECT_LT(waits("laser"), Duration::milliseconds(3) - frame * 9 + unsure);
  EXPECT_GT(waits("camera"), Duration::milliseconds(3) - frame);
  // Lists of another CAN may be there at the same time.
  cluster.can_buses.push_back(bus);
  for (model::Node& node : cluster.nodes)
    for (model::Task& task : node.tasks)
      for (auto* bindings : {&task.reads, &task.writes})
        for (model::PortBinding& binding : *bindings)
          if (binding.medium.is_can() && cluster.pdu(binding.pdu).name == "camera_objects")
            binding.medium = model::MediumId::can(cluster.can_buses.size() - 1);
  EXPECT_GT(waits("laser"), Duration::milliseconds(3));
}

// A list written by the start of slot 3 of an odd cycle is fused in that cycle at 1 ms; a later one 10 ms
// later. BUFF holds a list for at most the way to the slot, 0.832 ms from there to the fusion, and the 10 ms.
// A stamp may be 1.5 us off.
TEST(Ages, OfHeldMeasurements) {
  const auto ages = measurement_ages(small(false));
  EXPECT_EQ(ages[0].buffered_fused_worst.ns, 1'000'000 + kRounding + kApart + 1'500 + 832'000 + 10'000'000 + kClocks);
  EXPECT_EQ(ages[0].buffered_use_worst.ns, ages[0].buffered_fused_worst.ns + 4'500'000);
  EXPECT_EQ(ages[0].buffered_newest_worst - ages[0].buffered_use_worst, ages[0].newest_worst - ages[0].use_worst);
}

// The same with a CAN before the bus, and with tasks activated by messages and by other tasks. Classic CAN, 8
// bytes at 1 Mbit/s, takes 135 us at worst, 111 us at best, of both less the 4 us behind
// its acceptance:
//
//   device:   measure 1 ms -> CAN
//   gateway:  forward, on the list's arrival, 0.2 to 0.5 ms -> list in slot 3 of every cycle
//   fusion:   fuse 2 ms at 1 ms of odd cycles; publish 0.1 ms when it ends -> image in slot 4 of every cycle
//   user:     use, on the image's arrival
model::Cluster over_can(bool scheduled) {
  model::Cluster cluster = small(scheduled);
  model::PduLayout raw;
  raw.fragment_bytes = 8;
  raw.max_elements = raw.elements_per_fragment = 1;
  raw.sensor = SensorId{0};
  cluster.pdus.push_back(raw);  // PduId 2
  model::CanBus bus;
  bus.name = "can";
  bus.nominal_bit_rate = bus.data_bit_rate = 1'000'000;
  bus.messages = {{PduId{2}, 100, NodeId{0}, Duration::milliseconds(9), 0}};
  cluster.can_buses = {bus};
  cluster.nodes[0].tasks[0].writes = {{"raw", PduId{2}, model::MediumId::can(0), 0}};
  model::Task forward = timed("forward", {}, Duration::microseconds(500));
  forward.activation.kind = model::ActivationKind::kMessage;
  forward.activation.port = "in";
  forward.best_case = Duration::microseconds(200);
  forward.reads = {{"in", PduId{2}, model::MediumId::can(0), 0}};
  forward.writes = {{"out", PduId{0}, model::kFlexRay, 0}};
  cluster.nodes.push_back(cluster.nodes[0]);
  cluster.nodes[3].tasks = {forward};
  cluster.frames[0].sender = NodeId{3};
  cluster.frames[1].base_cycle = 0;
  cluster.frames[1].repetition = 1;
  model::Task& publish = cluster.nodes[1].tasks[1];
  publish.activation = {};
  publish.activation.kind = model::ActivationKind::kCompletion;
  publish.activation.after = "fuse";
  model::Task& use = cluster.nodes[2].tasks[0];
  use.activation = {};
  use.activation.kind = model::ActivationKind::kMessage;
  use.activation.port = "image";
  return cluster;
}

TEST(Ages, OverACanAndATaskThatAMessageActivates) {
  const auto ages = measurement_ages(over_can(false));
  ASSERT_EQ(ages.size(), 1u);
  // measure, CAN, forward, and the frame from its action point on; three stages are rounded.
  EXPECT_EQ(ages[0].fusion_best.ns, 1'000'000 + 107'000 + 200'000 - 3 * kRounding + 65'200 - kClocks);
  EXPECT_EQ(ages[0].fusion_worst.ns, 1'000'000 + 131'000 + 500'000 + 3 * kRounding + 5'084'000 - 1 + kClocks);
  ASSERT_EQ(ages[0].to_fusion.size(), 5u);
  EXPECT_EQ(ages[0].to_fusion[1].name, " on can");
  EXPECT_EQ(ages[0].to_fusion[1].worst.ns, 131'000 + kRounding);
}

// Another message of lower priority: a frame of it has just begun.
TEST(Ages, AFrameOfLowerPriorityOnTheCanIsWaitedFor) {
  model::Cluster cluster = over_can(false);
  cluster.pdus.push_back(cluster.pdus[2]);
  cluster.pdus[3].sensor = kNoSensor;
  cluster.can_buses[0].messages.push_back({PduId{3}, 200, NodeId{3}, Duration::milliseconds(9), 0});
  const auto plain = measurement_ages(over_can(false)), delayed = measurement_ages(cluster);
  EXPECT_EQ(delayed[0].fusion_best, plain[0].fusion_best);
  EXPECT_EQ(delayed[0].fusion_worst.ns - plain[0].fusion_worst.ns, 135'000);
}

// Fused at 6 ms, ended at 8 ms, published at 8.1 ms, in slot 4 of the next cycle: 10.252 to 10.336 ms, used
// on arrival.
TEST(Ages, PublishedWhenTheFusionEndsAndUsedWhenTheImageArrives) {
  const auto ages = measurement_ages(over_can(true));
  ASSERT_TRUE(ages[0].reaches_use);
  EXPECT_EQ(ages[0].fused_worst.ns, 6'000'000 + kClocks);
  EXPECT_EQ(ages[0].use_worst.ns, 10'336'000 + kClocks);
  EXPECT_EQ(ages[0].use_best.ns, 10'252'000 + 7'000 + 65'200 - kClocks);
}

// The sensor's list activates it instead: such a list comes within two periods of 10 ms.
TEST(Ages, AListWaitsForTheOneThatActivatesItsReader) {
  model::Cluster cluster = over_can(true);
  model::Task& use = cluster.nodes[2].tasks[0];
  use.reads.push_back({"tick", PduId{0}, model::kFlexRay, 0});
  use.activation.port = "tick";
  const auto ages = measurement_ages(cluster);
  EXPECT_EQ(ages[0].use_worst.ns, 10'336'000 + 20'000'000 + kRounding + kClocks);
  EXPECT_EQ(ages[0].use_best.ns, 10'252'000 + 7'000 + 65'200 - kClocks);
}

// The fusion follows a task of 0.3 ms that time activates every 10 ms. A list that just missed it waits for
// the next one: a period and that task's end later.
TEST(Ages, AListWaitsForTheBeginningOfAChain) {
  model::Cluster cluster = small(true);
  model::Task prepare = timed("prepare", {1, 2, Macroticks{1000}}, Duration::microseconds(300));
  model::Task& fuse = cluster.nodes[1].tasks[0];
  fuse.activation = {};
  fuse.activation.kind = model::ActivationKind::kCompletion;
  fuse.activation.after = "prepare";
  cluster.nodes[1].tasks.insert(cluster.nodes[1].tasks.begin(), prepare);
  const auto ages = measurement_ages(cluster);
  EXPECT_EQ(ages[0].fused_best, ages[0].fusion_best);
  EXPECT_EQ(ages[0].fused_worst.ns, 5'252'000 + 10'300'000 + kRounding + kClocks);
}

TEST(Ages, ASensorNobodyFusesIsLeftOut) {
  model::Cluster cluster = small(true);
  cluster.nodes[1].tasks[0].reads.clear();
  EXPECT_TRUE(measurement_ages(cluster).empty());
}

// The fusion reads a sample of odometry at once, and no image shows it.
TEST(Ages, OdometryIsNoObservation) {
  model::Cluster cluster = small(false);
  const AgePath observed = measurement_ages(cluster)[0];
  cluster.sensors[0].kind = model::SensorKind::kOdometry;
  EXPECT_TRUE(measurement_ages(cluster).empty());
  const auto ages = odometry_ages(cluster);
  ASSERT_EQ(ages.size(), 1u);
  EXPECT_EQ(ages[0].fused_worst, observed.fused_worst);
  EXPECT_FALSE(ages[0].reaches_use);
  EXPECT_EQ(ages[0].buffered_fused_worst, Duration{});
  EXPECT_EQ(ages_text(cluster).find("BUFF"), std::string::npos);
}

}  // namespace
}  // namespace ttf::schedules::analysis
