// A fault report from the records of whole drives, against their real disturbances. The faults' records are
// made up: the report has only those and the drive's records.
#include "evaluation/faults/fault_account.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <vector>

#include "sim/medium/disturbance.h"
#include "tests/evaluation/faults/fault_findings.h"
#include "tests/sim/drives/living_drive.h"

namespace ttf::evaluation::faults {
namespace {

using fusion::strategies::StrategyKind;
using schedules::model::Channel;

// Frames of `sender` that `receiver` does not get, on some channels, between two instants.
struct Deaf final : sim::medium::Disturbance {
  NodeId sender{}, receiver{};
  std::vector<Channel> channels;
  TrueTime from{}, to{};
  std::function<void(ttf::TrueTime)> acted;
  bool arriving(sim::medium::Arriving& signal) override {
    if (signal.sender != sender || signal.receiver != receiver || signal.start < from || signal.start >= to ||
        std::find(channels.begin(), channels.end(), signal.channel) == channels.end())
      return true;
    if (acted) acted(signal.start);
    return false;
  }
};

// A drive whose report is made while it runs, with made-up fault records.
struct Reported {
  schedules::model::Cluster cluster;
  FaultAccount report;
  sim::drives::LivingDrive drive;

  explicit Reported(FaultKind kind, const char* node = nullptr)
      : cluster(schedules::file::load_cluster(sim::drives::shipped("schedules/paper_synchronised.yaml"))),
        report(cluster, plan(kind, node), true), drive(StrategyKind::kTt, &report) {}
  ttf::faults::FaultPlan plan(FaultKind kind, const char* node) const {
    ttf::faults::FaultPlan plan;
    ttf::faults::Fault& fault = plan.faults.emplace_back();
    fault.kind = kind;
    fault.node_name = node == nullptr ? "" : node;
    fault.direction = ttf::faults::FaultDirection::kBoth;
    return ttf::faults::resolve(plan, cluster);
  }
  NodeId node(const char* name) const { return *cluster.find_node(name); }
  void says(recording::records::FaultAct what, TrueTime at, NodeId faulty, const char* text) {
    recording::records::FaultActivity activity;
    activity.at = at;
    activity.what = what;
    activity.node = faulty;
    activity.kind = "made_up";
    activity.text = text;
    report.on(activity);
  }
  void begins(double at, NodeId faulty = kNoNode) {
    drive.run_to(at);
    says(recording::records::FaultAct::kBegins, sim::drives::at_s(at), faulty, "");
    says(recording::records::FaultAct::kActs, sim::drives::at_s(at), faulty, "it acts");
  }
  const FaultSeen& fault() const { return report.findings().faults.at(0); }
  const FaultEffects& unattributed() const { return report.findings().unattributed; }
  bool harmed() const { return report.findings().harmed(); }
};

TEST(FaultAccount, OfAFaultThatDoesNothingNothingIsSeen) {
  Reported run(FaultKind::kTransient);
  run.begins(0.5);
  run.drive.run_to(2.0);
  ASSERT_EQ(run.report.findings().faults.size(), 1u);
  EXPECT_EQ(run.fault().acts, 1u);
  EXPECT_EQ(run.fault().text, "it acts");
  EXPECT_TRUE(run.fault().nothing());
  EXPECT_TRUE(run.unattributed().nothing());
}

TEST(FaultAccount, WithoutAFaultThereIsNothingToReport) {
  Reported run(FaultKind::kTransient);
  run.drive.off("laser_pre", 0.5);
  run.drive.run_to(1.0);
  EXPECT_TRUE(run.report.findings().faults.empty());
  EXPECT_TRUE(run.unattributed().nothing());
}

// A dead host: the four others miss its status frame in every cycle, without harm.
TEST(FaultAccount, ASilentNodeIsMissedInEveryCycleAndHarmsNobody) {
  Reported run(FaultKind::kCrash, "laser_pre");
  run.begins(0.5, run.node("laser_pre"));
  run.drive.off("laser_pre", 0.5);
  run.drive.run_to(1.5);
  EXPECT_NEAR(static_cast<double>(others(run.fault(), Check::kNoFrame).cycles), 200.0, 2.0) << "1 s of cycles of 5 ms";
  EXPECT_EQ(others(run.fault(), Check::kNoFrame).nodes.size(), 4u);
  EXPECT_EQ(others(run.fault(), Check::kSyntax).cycles, 0u);
  EXPECT_FALSE(run.harmed());
  EXPECT_TRUE(run.unattributed().nothing());
}

// The feature service receives no frame of the gateway for 20 cycles. On one channel it is reported, on both it
// is harm. The made-up cause is a fault on the channel.
TEST(FaultAccount, AFrameLostOnBothChannelsIsHarmOnOneItIsNot) {
  for (const bool both : {false, true}) {
    Reported run(FaultKind::kTransient);
    Deaf deaf;
    deaf.sender = run.node("gateway");
    deaf.receiver = run.node("feature");
    deaf.channels = both ? std::vector{Channel::kA, Channel::kB} : std::vector{Channel::kB};
    deaf.from = sim::drives::at_s(0.5) + Duration::milliseconds(1);
    deaf.to = deaf.from + Duration::milliseconds(100);
    deaf.acted = [&](TrueTime at) { run.says(recording::records::FaultAct::kActs, at, kNoNode, "it acts"); };
    run.drive.simulation->set_disturbance(&deaf);
    run.begins(0.5);
    run.drive.run_to(1.5);
    EXPECT_EQ(others(run.fault(), Check::kNoFrame).cycles, 20u);
    EXPECT_EQ(others(run.fault(), Check::kNoFrame).nodes, std::vector{deaf.receiver});
    EXPECT_EQ(run.harmed(), both);
    EXPECT_TRUE(run.unattributed().nothing());
    ASSERT_EQ(harm(run.fault(), Harm::kFrameLost).size(), both ? 1u : 0u);
    if (!both) continue;
    const HarmSeen& lost = harm(run.fault(), Harm::kFrameLost)[0];
    EXPECT_EQ(lost.sender, deaf.sender);
    EXPECT_EQ(lost.node, deaf.receiver);
    EXPECT_GE(lost.first, deaf.from);
    EXPECT_LT(lost.first, deaf.from + Duration::milliseconds(5));
    EXPECT_GE(lost.times, 20u);
    EXPECT_TRUE(harm(run.fault(), Harm::kFrameForged).empty());
  }
}

// The same deafness belongs to no fault of the plan if the plan's fault is another node's.
TEST(FaultAccount, AnEffectThatFitsNoFaultIsUnattributed) {
  Reported run(FaultKind::kCrash, "laser_pre");
  Deaf deaf;
  deaf.sender = run.node("gateway");
  deaf.receiver = run.node("feature");
  deaf.channels = {Channel::kA, Channel::kB};
  deaf.from = sim::drives::at_s(0.5) + Duration::milliseconds(1);
  deaf.to = deaf.from + Duration::milliseconds(100);
  run.drive.simulation->set_disturbance(&deaf);
  run.begins(0.5, run.node("laser_pre"));
  run.drive.run_to(1.5);
  EXPECT_TRUE(run.fault().nothing());
  EXPECT_EQ(others(run.unattributed(), Check::kNoFrame).cycles, 20u);
  EXPECT_EQ(harmed_nodes(run.unattributed(), Harm::kFrameLost), std::set{deaf.receiver});
  EXPECT_TRUE(run.harmed());
}

// The last frames of a run are due like all others: it ends after the static segment in which they were lost.
TEST(FaultAccount, AFrameLostInTheLastCycleIsHarm) {
  for (const bool reported : {false, true}) {
    Reported run(FaultKind::kTransient);
    Deaf deaf;
    deaf.sender = run.node("gateway");
    deaf.receiver = run.node("feature");
    deaf.channels = {Channel::kA, Channel::kB};
    deaf.from = sim::engine::kFirstCycle + run.cluster.cycle() * 200 - Duration::microseconds(100);
    deaf.to = deaf.from + Duration::milliseconds(100);
    deaf.acted = [&](TrueTime at) { run.says(recording::records::FaultAct::kActs, at, kNoNode, "it acts"); };
    run.drive.simulation->set_disturbance(&deaf);
    run.begins(0.5);
    const TrueTime end =
        sim::engine::kFirstCycle + run.cluster.cycle() * 200 + Duration::microseconds(reported ? 3'500 : 3'000);
    run.drive.simulation->run_until(end);
    EXPECT_FALSE(run.harmed()) << "it is settled when the run is over";
    run.report.finish(end);
    EXPECT_EQ(harmed_nodes(run.fault(), Harm::kFrameLost).count(deaf.receiver), reported ? 1u : 0u);
    EXPECT_EQ(run.harmed(), reported);
  }
}

// A fault of the node's own reception harms no other node.
TEST(FaultAccount, FramesThatTheFaultyNodeMissesAreNoHarm) {
  Reported run(FaultKind::kOmission, "feature");
  Deaf deaf;
  deaf.sender = run.node("gateway");
  deaf.receiver = run.node("feature");
  deaf.channels = {Channel::kA, Channel::kB};
  deaf.from = sim::drives::at_s(0.5);
  deaf.to = sim::drives::at_s(0.6);
  run.drive.simulation->set_disturbance(&deaf);
  run.begins(0.5, deaf.receiver);
  run.drive.run_to(1.5);
  EXPECT_EQ(others(run.fault(), Check::kNoFrame).cycles, 0u);
  EXPECT_GE(faulty(run.fault(), Check::kNoFrame).cycles, 19u);
  EXPECT_FALSE(run.harmed());
  EXPECT_TRUE(run.unattributed().nothing());
}

// The fault-free clocks part when one of them drifts away: frames alone show it, for any faulty node.
TEST(FaultAccount, ClocksThatPartAreHarmUnlessTheOneThatPartsIsFaulty) {
  for (const bool named : {true, false}) {
    Reported run(named ? FaultKind::kDrift : FaultKind::kTransient, named ? "feature" : nullptr);
    run.begins(0.5, named ? run.node("feature") : kNoNode);
    run.drive.simulation->change_drift(run.node("feature"), 8'000'000);
    run.drive.run_to(0.8);
    EXPECT_EQ(harm(run.fault(), Harm::kPrecision).size(), named ? 0u : 1u);
    EXPECT_EQ(harmed_nodes(run.unattributed(), Harm::kPrecision).size(), 0u);
    if (named) {
      EXPECT_TRUE(run.unattributed().nothing());
    }
  }
}

// H1: fault-free nodes lose their supply, one after the other, during another node's crash: each is named.
TEST(FaultAccount, EveryNodeThatLeavesNormalActiveIsNamed) {
  Reported run(FaultKind::kCrash, "laser_pre");
  run.begins(0.5, run.node("laser_pre"));
  run.drive.off("laser_pre", 0.5);
  EXPECT_FALSE(run.harmed());
  run.drive.off("camera_pre", 0.6);
  run.drive.off("gateway", 0.7);
  run.drive.run_to(0.8);
  const std::vector<HarmSeen>& left = harm(run.fault(), Harm::kLeftActive);
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].node, run.node("camera_pre"));
  EXPECT_NEAR(static_cast<double>(left[0].first.ns), 0.6e9, 50.0) << "a microtick";
  EXPECT_EQ(left[1].node, run.node("gateway"));
  EXPECT_NEAR(static_cast<double>(left[1].first.ns), 0.7e9, 50.0);
}

// H5: records of a controller that sends nothing on B in its own slot, while a forger sends a valid frame
// there. The others take it for the controller's. The record of the sent frame is missing, without any
// complaint.
struct Forged final : recording::records::Sink {
  using recording::records::Sink::on;
  recording::records::Sink* to = nullptr;
  NodeId sender{};
  TrueTime from{};
  TrueTime until{};
  void on(const recording::records::SlotFrameSent& frame) override {
    const bool taken = frame.stamp.node == sender && frame.channel == 1 && frame.stamp.true_time >= from &&
                       frame.stamp.true_time < until;
    if (!taken) to->on(frame);
  }
  void on(const recording::records::SlotProblem& problem) override { to->on(problem); }
};

TEST(FaultAccount, AFrameThatItsOwnerDidNotSendIsForgedForAllWhoTookIt) {
  Forged forged;
  sim::drives::LivingDrive drive(StrategyKind::kTt, &forged);
  ttf::faults::FaultPlan plan;
  ttf::faults::Fault& fault = plan.faults.emplace_back();
  fault.kind = FaultKind::kMasquerading;
  fault.node = *drive.drive.cluster.find_node("laser_pre");
  fault.channels = schedules::model::Channels::kB;
  FaultAccount report(drive.drive.cluster, plan, true);
  forged.to = &report;
  forged.sender = *drive.drive.cluster.find_node("gateway");
  forged.from = sim::engine::kFirstCycle + drive.drive.cluster.cycle() * 100;
  forged.until = forged.from + drive.drive.cluster.cycle();
  drive.simulation->run_until(forged.from);
  recording::records::FaultActivity activity{forged.from,    0, recording::records::FaultAct::kBegins, fault.node,
                                             "masquerading", ""};
  report.on(activity);
  activity.what = recording::records::FaultAct::kActs;
  for (int us = 0; us < 5'000; us += 50) {
    activity.at = forged.from + Duration::microseconds(us);
    report.on(activity);
  }
  drive.run_to(0.6);
  EXPECT_TRUE(report.findings().unattributed.nothing());
  const FaultEffects& effects = report.findings().faults.at(0);
  std::set<NodeId> victims;
  for (const char* name : {"camera_pre", "fusion", "feature"}) victims.insert(*drive.drive.cluster.find_node(name));
  EXPECT_EQ(harmed_nodes(effects, Harm::kFrameForged), victims) << "all but the faulty one and the owner";
  for (const HarmSeen& one : harm(effects, Harm::kFrameForged)) EXPECT_EQ(one.sender, forged.sender);
  EXPECT_TRUE(harm(effects, Harm::kFrameLost).empty()) << "on A it came";
}

}  // namespace
}  // namespace ttf::evaluation::faults
