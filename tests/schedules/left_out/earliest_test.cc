#include "schedules/left_out/earliest.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "tests/schedules/cluster_file.h"
#include "tests/schedules/small_cluster.h"

namespace ttf::schedules::left_out {
namespace {

// The small cluster with the image's and the sensor's lists left out, and nothing else.
struct Small {
  model::Cluster cluster = small(true);
  Parts parts;
  Findings findings;

  Small() {
    cluster.frames.clear();
    cluster.file = "small.yaml";
    for (std::size_t n = 0; n < 3; ++n) cluster.nodes[n].name = std::string("abc").substr(n, 1);
    for (const model::Node& node : cluster.nodes) parts.tasks.emplace_back(node.tasks.size());
    parts.sensors.resize(1);
    parts.lists = {{PduId{0}, NodeId{0}, model::Channels::kAB, 0, 1, 1, {true, true}, 7, 0},
                   {PduId{1}, NodeId{1}, model::Channels::kAB, 0, 1, 1, {true, true}, 0, 1}};
  }
  void leave_out_instants() {
    parts.sensors[0].instant = true;
    for (auto& tasks : parts.tasks)
      for (TaskParts& task : tasks) task.at.instant = true;
    parts.tasks[0][0].at.instant = false;  // the sensor's
  }
  void put() { put_earliest(cluster, parts, findings); }
  const model::CycleInstant& at(std::size_t node, std::size_t task) const {
    return cluster.nodes[node].tasks[task].activation.at;
  }
};

// Times by hand: clocks differ by 7850 ns, and an execution counts 1 ns for its rounding.
TEST(EarliestInstants, FollowTheDataFromTheMeasurementToTheUse) {
  Small one;
  one.leave_out_instants();
  one.put();
  ASSERT_EQ(sentences(one.findings.list()), "");
  EXPECT_EQ(one.cluster.sensors[0].at.base_cycle, 0);
  EXPECT_EQ(one.cluster.sensors[0].at.offset.value, 0);
  // Written by 1 ms + 7.95 us, so 1008 = 12 * 84: slot 13.
  EXPECT_EQ(one.parts.lists[0].slot, 13);
  EXPECT_EQ(one.parts.lists[0].base_cycle, 0);
  EXPECT_EQ(one.parts.lists[0].repetition, 2);
  // The slot ends at 1092, and 7.85 us later by any clock.
  EXPECT_EQ(one.at(1, 0).base_cycle, 0);
  EXPECT_EQ(one.at(1, 0).offset.value, 1100);
  // Fusion takes 2 ms of the node's clock; corrections make a difference of a few macroticks.
  EXPECT_EQ(one.at(1, 1).base_cycle, 0);
  EXPECT_GE(one.at(1, 1).offset.value, 3100);
  EXPECT_LE(one.at(1, 1).offset.value, 3120);
  // The image is written by 3.2 ms, behind all 20 static slots: it waits for the next cycle.
  EXPECT_EQ(one.parts.lists[1].base_cycle, 1);
  EXPECT_EQ(one.parts.lists[1].slot, 1);
  EXPECT_EQ(one.at(2, 0).base_cycle, 1);
  EXPECT_EQ(one.at(2, 0).offset.value, 92);
  EXPECT_EQ(one.cluster.frames.size(), 2U);
}

TEST(EarliestInstants, InstantsOfTheFileStand) {
  Small one;  // the tasks' instants stay
  one.put();
  ASSERT_EQ(sentences(one.findings.list()), "");
  EXPECT_EQ(one.at(1, 0).base_cycle, 1);
  EXPECT_EQ(one.at(1, 0).offset.value, 1000);
  EXPECT_EQ(one.parts.lists[0].slot, 13);
  // The image is written at the start of even cycles, by 100 us: 108 leads to slot 3.
  EXPECT_EQ(one.parts.lists[1].base_cycle, 0);
  EXPECT_EQ(one.parts.lists[1].slot, 3);
  EXPECT_EQ(one.at(2, 0).offset.value, 500);
}

TEST(EarliestInstants, AListKeepsOffTheSlotsOfOthers) {
  Small one;
  one.cluster.frames = {{14, model::Channels::kA, 1, 4, NodeId{2}, kNoPdu, 0, 0},   // odd cycles
                        {13, model::Channels::kB, 2, 4, NodeId{2}, kNoPdu, 0, 0}};  // every other even one
  one.put();
  ASSERT_EQ(sentences(one.findings.list()), "");
  EXPECT_EQ(one.parts.lists[0].slot, 14);
}

TEST(EarliestInstants, TasksOfANodeTakeTurns) {
  for (const auto& [image, cycle, earliest] : {std::tuple{900, 0, 4500}, {1000, 1, 2500}}) {
    Small one;
    one.leave_out_instants();
    // Another task has the processor from 0.5 to 2.5 ms of every cycle.
    model::Task other = timed("other", {0, 1, Macroticks{500}}, Duration::milliseconds(2));
    one.cluster.nodes[1].tasks.push_back(other);
    one.parts.tasks[1].push_back({});
    one.cluster.nodes[1].tasks[1].worst_case = Duration::microseconds(image);
    one.put();
    ASSERT_EQ(sentences(one.findings.list()), "");
    EXPECT_EQ(one.at(1, 0).base_cycle, 0);
    EXPECT_GE(one.at(1, 0).offset.value, 2500);
    EXPECT_LE(one.at(1, 0).offset.value, 2510);
    // Fusion ends at 4.5 ms, and there is room for 1 ms less what clocks differ by until the other task's next turn.
    EXPECT_EQ(one.at(1, 1).base_cycle, cycle);
    EXPECT_GE(one.at(1, 1).offset.value, earliest);
    EXPECT_LE(one.at(1, 1).offset.value, earliest + 10);
  }
}

// The image's task follows the one that fuses. Both have the processor, and the image is written by 3.2 ms all the same.
TEST(EarliestInstants, TasksThatFollowCount) {
  Small one;
  one.leave_out_instants();
  model::Task& publish = one.cluster.nodes[1].tasks[1];
  publish.activation = {};
  publish.activation.kind = model::ActivationKind::kCompletion;
  publish.activation.after = "fuse";
  one.parts.tasks[1][1].at = {};
  // The processor is free from 1.5 to 3.55 ms: enough for fusion, and not for both.
  one.cluster.nodes[1].tasks.push_back(timed("other", {0, 1, Macroticks{3550}}, Duration::microseconds(2950)));
  one.parts.tasks[1].push_back({});
  one.put();
  EXPECT_NE(sentences(one.findings.list()).find("the other tasks of the node leave no time for it"), std::string::npos);
}

TEST(EarliestInstants, AFrameHasARepetitionThatControllersSupport) {
  Small one;
  one.cluster.flexray.gCycleCountMax = 59;
  one.cluster.sensors[0].at.repetition = 6;
  one.put();
  EXPECT_EQ(one.parts.lists[0].repetition, 2);  // of 1, 2, 4, 5, 10, 20
}

TEST(EarliestInstants, WithoutRoomOrBeginningThereIsASentence) {
  {
    Small one;
    one.cluster.nodes[0].tasks[0].activation.kind = model::ActivationKind::kMessage;  // no one sends it
    one.put();
    EXPECT_EQ(sentences(one.findings.list()),
              "\n  small.yaml:7: frames[0].slot: must be in the file: it takes nothing that the schedule begins");
  }
  {
    Small one;
    for (int slot = 1; slot <= 20; ++slot)
      one.cluster.frames.push_back({slot, model::Channels::kA, 0, 1, NodeId{2}, kNoPdu, 0, 0});
    one.put();
    EXPECT_EQ(one.findings.list().size(), 2U);
    EXPECT_NE(sentences(one.findings.list()).find("finds no free static slots"), std::string::npos);
  }
  {
    Small one;
    one.leave_out_instants();
    one.cluster.nodes[1].tasks.push_back(timed("other", {0, 1, Macroticks{0}}, Duration::microseconds(3500)));
    one.parts.tasks[1].push_back({});
    one.put();
    EXPECT_NE(sentences(one.findings.list())
                  .find("nodes.b.tasks.fuse.activation.offset: must be in the file: the other tasks of the "
                        "node leave no time for it"),
              std::string::npos)
        << sentences(one.findings.list());
  }
}

// The sensor's list waits for a task that waits for the list.
TEST(EarliestInstants, ARingIsNamed) {
  Small one;
  one.leave_out_instants();
  model::Task& measure = one.cluster.nodes[0].tasks[0];
  measure.activation = {};
  measure.reads = {{"image", PduId{1}, model::kFlexRay, 0}};
  one.parts.tasks[0][0].at.instant = true;
  one.put();
  EXPECT_EQ(
      sentences(one.findings.list()),
      "\n  small.yaml: nodes.a.tasks.measure.activation.offset: must be in the file: nodes.a.tasks.measure.activation "
      "waits for frames[1], which waits for nodes.b.tasks.publish.activation, which waits for "
      "nodes.b.tasks.fuse.activation, which waits for frames[0], which waits for the first");
}

TEST(EarliestInstants, ARingEndsWhereTheFileSaysAnInstant) {
  Small one;
  one.leave_out_instants();
  model::Task& measure = one.cluster.nodes[0].tasks[0];
  measure.activation = {};
  measure.activation.at = {1, 2, Macroticks{200}};
  measure.reads = {{"image", PduId{1}, model::kFlexRay, 0}};
  one.put();
  EXPECT_EQ(sentences(one.findings.list()), "");
  EXPECT_EQ(one.parts.lists[0].base_cycle, 1);
  EXPECT_EQ(one.parts.lists[0].slot, 16);  // 1208 of 84
}

TEST(KeySlots, AListOfOneFrameMayStandInOne) {
  Small one;
  for (std::size_t n = 0; n < 3; ++n) one.cluster.nodes[n].flexray->pKeySlotId = static_cast<int>(n) + 5;
  use_key_slots(one.cluster, one.parts.lists);
  EXPECT_EQ(one.parts.lists[0].slot, 5);
  EXPECT_EQ(one.parts.lists[1].slot, 6);
  EXPECT_EQ(one.parts.lists[1].repetition, 1);
  EXPECT_FALSE(one.parts.lists[0].at.instant || one.parts.lists[0].at.repetition);
}

}  // namespace
}  // namespace ttf::schedules::left_out
