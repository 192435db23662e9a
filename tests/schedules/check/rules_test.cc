// A bus description is checked as far as the bus goes; the rules that need tasks are skipped and named.
#include "schedules/check/rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "schedules/exchange/cluster_text.h"
#include "schedules/file/loader.h"

namespace ttf::schedules::check {
namespace {

using testing::HasSubstr;

model::Cluster shipped() { return file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_dynamic.yaml"); }

// The part of a cluster that another tool has.
model::Cluster bus_of(model::Cluster cluster) {
  for (model::Node& node : cluster.nodes) node.tasks.clear();
  cluster.sensors.clear();
  for (model::PduLayout& pdu : cluster.pdus) pdu.sensor = kNoSensor;
  cluster.can_buses.clear();
  return cluster;
}

TEST(Rules, ABusDescriptionIsCheckedWithoutThoseThatNeedTasks) {
  const model::Cluster whole = shipped(), bus = bus_of(whole);
  EXPECT_TRUE(whole.describes_tasks());
  EXPECT_EQ(skipped_text(whole), "");
  EXPECT_FALSE(bus.describes_tasks());
  EXPECT_TRUE(check(bus).empty());
  EXPECT_EQ(
      skipped_text(bus),
      "paper_dynamic describes no tasks, so these are not checked: activations and deadlines of tasks, writers and "
      "readers of lists, sensors that follow their hosts, modes of tasks, ages within a round of cycles");
  EXPECT_THAT(exchange::show_text(bus), HasSubstr("\nno tasks, sensors and CANs are described\n"));
  model::Cluster broken = bus;
  broken.flexray.gdNIT += 1;
  EXPECT_FALSE(check(broken).empty()) << "the bus has its rules";
}

TEST(Rules, OneTaskOrSensorIsEnoughForAllRules) {
  const model::Cluster whole = shipped();
  model::Cluster one = bus_of(whole);
  for (const model::Task& task : whole.node(*whole.find_node("fusion")).tasks) {
    if (task.activation.kind != model::ActivationKind::kTime) continue;
    model::Task& alone = one.nodes[index_of(*one.find_node("fusion"))].tasks.emplace_back(task);
    alone.reads.clear();
    alone.writes.clear();
    break;
  }
  EXPECT_TRUE(one.describes_tasks());
  EXPECT_FALSE(check(one).empty());
  one = bus_of(whole);
  one.sensors = whole.sensors;
  EXPECT_FALSE(check(one).empty());
}

// A foreign frame of the dynamic segment carries no list of ours, and has a length of its own.
TEST(Rules, ForeignDynamicFramesAreForBusDescriptionsOnly) {
  const auto with_frame = [](model::Cluster cluster) {
    model::FrameSlot frame = cluster.frames.back();
    frame.pdu = kNoPdu;
    frame.fragment = 0;
    frame.message_id.reset();
    frame.network_management = false;
    frame.slot = cluster.flexray.gNumberOfStaticSlots + cluster.flexray.gNumberOfMinislots;
    frame.payload_bytes = 7;
    cluster.frames.push_back(frame);
    return cluster;
  };
  const model::Cluster bus = with_frame(bus_of(shipped()));
  EXPECT_TRUE(check(bus).empty());
  EXPECT_THAT(exchange::show_text(bus), HasSubstr("7 bytes (dynamic)"));
  EXPECT_FALSE(check(with_frame(shipped())).empty());
}

TEST(Rules, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const ClusterRule& rule : rules()) {
    EXPECT_TRUE(names.insert(rule.name).second) << rule.name;
    EXPECT_FALSE(rule.subject.empty());
    EXPECT_NE(rule.check, nullptr);
  }
}

}  // namespace
}  // namespace ttf::schedules::check
