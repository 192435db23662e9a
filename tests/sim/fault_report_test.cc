// What a report of faults makes of the records of whole drives: against what was done to them.
#include "experiments/fault_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "recording/log_reader.h"
#include "recording/log_writer.h"
#include "sim/disturbance.h"
#include "tests/sim/living_drive.h"

namespace ttf {
namespace {

using experiments::Check;
using experiments::CheckSeen;
using experiments::FaultReport;
using experiments::FaultSeen;
using experiments::Harm;
using fusion::StrategyKind;
using schedules::Channel;
using testing_support::at_s;
using testing_support::LivingDrive;

// Frames of `sender` that `receiver` does not get, on some channels, between two instants.
struct Deaf final : sim::Disturbance {
  NodeId sender{}, receiver{};
  std::vector<Channel> channels;
  TrueTime from{}, to{};
  bool arriving(sim::Arriving& signal) override {
    return signal.sender != sender || signal.receiver != receiver || signal.start < from || signal.start >= to ||
           std::find(channels.begin(), channels.end(), signal.channel) == channels.end();
  }
};

// A drive whose report is made while it runs.
struct Reported {
  schedules::Cluster cluster;
  FaultReport report;
  LivingDrive drive;

  Reported()
      : cluster(schedules::load_cluster(testing_support::shipped("schedules/paper_synchronised.yaml"))),
        report(cluster, true),
        drive(StrategyKind::kTt, &report) {}
  NodeId node(const char* name) const { return *cluster.find_node(name); }
  void begins(double at, NodeId faulty) {
    drive.run_to(at);
    records::FaultActivity activity;
    activity.at = at_s(at);
    activity.what = records::kFaultBegins;
    activity.node = faulty;
    activity.kind = "made_up";
    report.on(activity);
    activity.what = records::kFaultActs;
    activity.text = "it acts";
    report.on(activity);
  }
  const FaultSeen& fault() const { return report.faults().at(0); }
  const CheckSeen& others(Check check) const { return fault().by_others[static_cast<std::size_t>(check)]; }
  const CheckSeen& faulty(Check check) const { return fault().by_faulty[static_cast<std::size_t>(check)]; }
  std::optional<experiments::Judgement::Harmed> harm(Harm harm) const {
    return fault().harms[static_cast<std::size_t>(harm)];
  }
  bool anything_seen() const {
    const auto seen = [](const CheckSeen& check) { return check.cycles > 0; };
    return std::any_of(fault().by_others.begin(), fault().by_others.end(), seen) ||
           std::any_of(fault().by_faulty.begin(), fault().by_faulty.end(), seen);
  }
};

TEST(FaultReport, OfAFaultThatDoesNothingNothingIsSeen) {
  Reported run;
  run.begins(0.5, kNoNode);
  run.drive.run_to(2.0);
  ASSERT_EQ(run.report.faults().size(), 1u);
  EXPECT_EQ(run.fault().acts, 1u);
  EXPECT_EQ(run.fault().text, "it acts");
  EXPECT_FALSE(run.anything_seen());
  EXPECT_TRUE(run.fault().states.empty());
  EXPECT_FALSE(run.report.harmed());
}

TEST(FaultReport, WithoutAFaultThereIsNothingToTell) {
  Reported run;
  run.drive.off("laser_pre", 0.5);
  run.drive.run_to(1.0);
  EXPECT_TRUE(run.report.faults().empty());
  EXPECT_FALSE(run.report.harmed());
}

// A dead host: the four others miss its status frame in every cycle, and that harms nobody.
TEST(FaultReport, ASilentNodeIsMissedInEveryCycleAndHarmsNobody) {
  Reported run;
  run.begins(0.5, run.node("laser_pre"));
  run.drive.off("laser_pre", 0.5);
  run.drive.run_to(1.5);
  EXPECT_NEAR(static_cast<double>(run.others(Check::kNoFrame).cycles), 200.0, 2.0) << "1 s of cycles of 5 ms";
  EXPECT_EQ(run.others(Check::kNoFrame).nodes.size(), 4u);
  EXPECT_EQ(run.others(Check::kSyntax).cycles, 0u);
  EXPECT_FALSE(run.report.harmed());
}

// The feature service hears nothing of the gateway for 20 cycles: on one channel it is told, on both it is harmed.
TEST(FaultReport, AFrameLostOnBothChannelsIsHarmOnOneItIsNot) {
  for (const bool both : {false, true}) {
    Reported run;
    Deaf deaf;
    deaf.sender = run.node("gateway");
    deaf.receiver = run.node("feature");
    deaf.channels = both ? std::vector{Channel::kA, Channel::kB} : std::vector{Channel::kB};
    deaf.from = at_s(0.5) + Duration::milliseconds(1);
    deaf.to = deaf.from + Duration::milliseconds(100);
    run.drive.simulation->set_disturbance(&deaf);
    run.begins(0.5, kNoNode);
    run.drive.run_to(1.5);
    EXPECT_EQ(run.others(Check::kNoFrame).cycles, 20u);
    EXPECT_EQ(run.others(Check::kNoFrame).nodes, std::vector{deaf.receiver});
    EXPECT_EQ(run.report.harmed(), both);
    ASSERT_EQ(run.harm(Harm::kFrameLost).has_value(), both);
    if (!both) continue;
    EXPECT_EQ(run.harm(Harm::kFrameLost)->sender, deaf.sender);
    EXPECT_EQ(run.harm(Harm::kFrameLost)->node, deaf.receiver);
    EXPECT_GE(run.harm(Harm::kFrameLost)->first, deaf.from);
    EXPECT_LT(run.harm(Harm::kFrameLost)->first, deaf.from + Duration::milliseconds(5));
    EXPECT_FALSE(run.harm(Harm::kFrameForged));
  }
}

// The same deafness where it is the faulty node's own is nobody else's harm.
TEST(FaultReport, WhatTheFaultyNodeMissesHarmsNobody) {
  Reported run;
  Deaf deaf;
  deaf.sender = run.node("gateway");
  deaf.receiver = run.node("feature");
  deaf.channels = {Channel::kA, Channel::kB};
  deaf.from = at_s(0.5);
  deaf.to = at_s(0.6);
  run.drive.simulation->set_disturbance(&deaf);
  run.begins(0.5, deaf.receiver);
  run.drive.run_to(1.5);
  EXPECT_EQ(run.others(Check::kNoFrame).cycles, 0u);
  EXPECT_GE(run.faulty(Check::kNoFrame).cycles, 19u);
  EXPECT_FALSE(run.report.harmed());
}

// The fault-free clocks part when one of them drifts away: told by the frames alone, whoever is said to be at fault.
TEST(FaultReport, ClocksThatPartAreHarmUnlessTheOneThatPartsIsFaulty) {
  for (const bool named : {true, false}) {
    Reported run;
    run.begins(0.5, named ? run.node("feature") : kNoNode);
    run.drive.simulation->change_drift(run.node("feature"), 8'000'000);
    run.drive.run_to(0.8);
    EXPECT_EQ(run.harm(Harm::kPrecision).has_value(), !named);
  }
}

// What the injector does to a drive, by a plan.
struct Planned {
  testing_support::Drive drive{"scenarios/paper_scenario1.yaml", StrategyKind::kTt};
  FaultReport report{drive.cluster, true};

  nodes::Fault& add(nodes::FaultKind kind, const char* node, std::int64_t from_ms, std::int64_t duration_ms) {
    nodes::Fault& fault = drive.scenario.faults.faults.emplace_back();
    fault.kind = kind;
    fault.node_name = node;
    fault.from = Duration::milliseconds(from_ms);
    fault.duration = Duration::milliseconds(duration_ms);
    return fault;
  }
  const FaultSeen& fault(std::size_t index = 0) const { return report.faults().at(index); }
  std::uint64_t cycles(Check check) const { return fault().by_others[static_cast<std::size_t>(check)].cycles; }
};

TEST(FaultReport, ATransientOnBothChannelsHarmsOnOneItDoesNot) {
  for (const bool both : {true, false}) {
    Planned run;
    run.add(nodes::FaultKind::kTransient, "", 1'000, 20).channels = both ? schedules::Channels::kAB : schedules::Channels::kA;
    run.drive.run(run.report);
    ASSERT_EQ(run.report.faults().size(), 1u);
    EXPECT_EQ(run.fault().kind, "transient");
    EXPECT_EQ(run.fault().node, kNoNode);
    EXPECT_GE(run.fault().acts, 4u);
    EXPECT_GE(run.cycles(Check::kSyntax), 3u);
    EXPECT_LE(run.cycles(Check::kSyntax), 5u);
    EXPECT_EQ(run.fault().harms[static_cast<std::size_t>(Harm::kFrameLost)].has_value(), both);
    EXPECT_EQ(run.report.harmed(), both);
  }
}

TEST(FaultReport, ACrashOfOneHarmsNoOther) {
  Planned run;
  run.add(nodes::FaultKind::kCrash, "gateway", 1'000, 500);
  run.drive.run(run.report);
  EXPECT_EQ(run.fault().node, *run.drive.cluster.find_node("gateway"));
  ASSERT_TRUE(run.fault().ends);
  EXPECT_EQ(*run.fault().ends - run.fault().begins, Duration::milliseconds(500));
  EXPECT_GE(run.cycles(Check::kNoFrame), 100u);
  EXPECT_FALSE(run.report.harmed());
  EXPECT_TRUE(std::any_of(run.fault().states.begin(), run.fault().states.end(),
                          [](const auto& state) { return state.to == "normal active"; }))
      << "it came back";
}

// A log tells what the run told.
TEST(FaultReport, IsTheSameFromTheLog) {
  testing_support::Drive drive("scenarios/faulty_bus.yaml", StrategyKind::kTt);
  FaultReport live(drive.cluster, true), logged(drive.cluster, true);
  const std::string path = testing::TempDir() + "/faulty_bus.mcap";
  recording::LogWriter log(path, {});
  records::Tee tee({&live, &log});
  drive.run(tee);
  log.close();
  recording::read_log(path, logged);
  std::filesystem::remove(path);
  ASSERT_EQ(live.faults().size(), drive.scenario.faults.faults.size());
  ASSERT_EQ(logged.faults().size(), live.faults().size());
  std::uint64_t cycles = 0;
  for (std::size_t f = 0; f < live.faults().size(); ++f) {
    const FaultSeen &a = live.faults()[f], &b = logged.faults()[f];
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.text, b.text);
    EXPECT_EQ(a.acts, b.acts);
    EXPECT_EQ(a.begins, b.begins);
    EXPECT_EQ(a.ends, b.ends);
    EXPECT_EQ(a.harmed(), b.harmed());
    ASSERT_EQ(a.states.size(), b.states.size());
    for (std::size_t s = 0; s < a.states.size(); ++s) EXPECT_EQ(a.states[s].why, b.states[s].why);
    for (std::size_t c = 0; c < a.by_others.size(); ++c) {
      EXPECT_EQ(a.by_others[c].cycles, b.by_others[c].cycles);
      EXPECT_EQ(a.by_others[c].nodes, b.by_others[c].nodes);
      EXPECT_EQ(a.by_faulty[c].cycles, b.by_faulty[c].cycles);
      cycles += a.by_others[c].cycles;
    }
  }
  EXPECT_GT(cycles, 100u);
}

// The distance of the clocks as frames tell it, against the simulator's own, which looks at all of a double cycle.
struct Spread final : records::Sink {
  using records::Sink::on;
  const schedules::Cluster& cluster;
  experiments::FrameClocks clocks;
  Duration since_sample{};
  std::vector<std::pair<Duration, Duration>> told_and_true;
  explicit Spread(const schedules::Cluster& c) : cluster(c), clocks(c) {}
  void on(const records::SlotFrameSent& frame) override {
    if (const auto apart = clocks.sent(frame)) since_sample = std::max(since_sample, *apart);
  }
  void on(const records::PrecisionSample& sample) override {
    told_and_true.emplace_back(since_sample, sample.precision);
    since_sample = {};
  }
};

TEST(FrameClocks, TellTheDistanceOfTheClocks) {
  const auto cluster = schedules::load_cluster(testing_support::shipped("schedules/paper_synchronised.yaml"));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Spread spread(cluster);
    LivingDrive drive(StrategyKind::kTt, &spread, seed);
    drive.run_to(2.0);
    ASSERT_GT(spread.told_and_true.size(), 100u);
    for (std::size_t i = 5; i < spread.told_and_true.size(); ++i) {
      const auto& [told, truth] = spread.told_and_true[i];
      EXPECT_LE(told, truth + Duration::nanoseconds(30)) << "seed " << seed << " double cycle " << i;
      EXPECT_GE(told.ns, truth.ns / 2 - 60) << "seed " << seed << " double cycle " << i;
    }
  }
}

}  // namespace
}  // namespace ttf
