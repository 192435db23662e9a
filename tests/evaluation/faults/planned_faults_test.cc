// Fault reports of drives with a plan, on a bus and behind guardians; live and from the log.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "recording/log/reader.h"
#include "recording/log/writer.h"
#include "sim/medium/disturbance.h"
#include "tests/evaluation/faults/fault_findings.h"

namespace ttf::evaluation::faults {
namespace {

using fusion::strategies::StrategyKind;

TEST(FaultAccount, ATransientOnBothChannelsHarmsOnOneItDoesNot) {
  for (const bool both : {true, false}) {
    Planned run;
    run.add(FaultKind::kTransient, "", 1'000, 20).channels =
        both ? schedules::model::Channels::kAB : schedules::model::Channels::kA;
    const FaultFindings& found = run.run();
    ASSERT_EQ(found.faults.size(), 1u);
    const FaultSeen& fault = found.faults[0];
    EXPECT_EQ(fault.kind, "transient");
    EXPECT_EQ(fault.node, kNoNode);
    EXPECT_GE(fault.acts, 4u);
    EXPECT_GE(others(fault, Check::kSyntax).cycles, 3u);
    EXPECT_LE(others(fault, Check::kSyntax).cycles, 5u);
    EXPECT_EQ(harmed_nodes(fault, Harm::kFrameLost), both ? run.on_flexray() : std::set<NodeId>())
        << "every one is named";
    EXPECT_EQ(found.harmed(), both);
    EXPECT_TRUE(found.unattributed.nothing());
  }
}

// The clocks run free for twenty cycles, too long to converge again. Effects belong to the transient as long
// as a controller tolerates missing sync frames; later they cannot be attributed.
TEST(FaultAccount, EffectsOfALongTransientAreItsOwnForAWhile) {
  Planned run;
  run.add(FaultKind::kTransient, "", 1'000, 100);
  const FaultFindings& found = run.run();
  EXPECT_EQ(harmed_nodes(found.faults.at(0), Harm::kFrameLost), run.on_flexray());
  EXPECT_GE(others(found.faults[0], Check::kSyntax).cycles, 20u);
  EXPECT_FALSE(found.unattributed.nothing());
  for (const auto& nodes : found.unattributed.harms)
    for (const HarmSeen& one : nodes) EXPECT_GT(one.first, *found.faults[0].ends + Duration::milliseconds(49));
}

TEST(FaultAccount, ACrashOfOneHarmsNoOther) {
  Planned run;
  run.add(FaultKind::kCrash, "gateway", 1'000, 500);
  const FaultFindings& found = run.run();
  const FaultSeen& fault = found.faults.at(0);
  EXPECT_EQ(fault.node, run.node("gateway"));
  ASSERT_TRUE(fault.ends);
  EXPECT_EQ(*fault.ends - fault.begins.value(), Duration::milliseconds(500));
  EXPECT_GE(others(fault, Check::kNoFrame).cycles, 100u);
  EXPECT_FALSE(found.harmed());
  EXPECT_TRUE(std::any_of(fault.states.begin(), fault.states.end(), [](const auto& state) {
    return state.to == "normal active";
  })) << "it came back";
  EXPECT_TRUE(found.unattributed.nothing());
}

// Five nodes start while the sixth has no supply: their steps are no effect of it, its late start is.
TEST(FaultAccount, TheStepsOfAStartUpAreNobodysDoing) {
  Planned run("scenarios/cold_start.yaml");
  run.add(FaultKind::kCrash, "camera", 1, 100);
  const FaultFindings& found = run.run();
  const FaultSeen& fault = found.faults.at(0);
  for (const auto& state : fault.states) EXPECT_EQ(state.node, run.node("camera")) << state.from << " to " << state.to;
  for (const char* to : {"with supply", "normal active"})
    EXPECT_TRUE(std::any_of(fault.states.begin(), fault.states.end(), [&](const auto& one) { return one.to == to; }))
        << to;
  EXPECT_TRUE(found.unattributed.states.empty());
}

// The leading node loses its supply when others have begun to follow. They are thrown back, and report it.
TEST(FaultAccount, StepsBackInAStartUpAreOfTheFault) {
  Planned run("scenarios/cold_start.yaml");
  run.add(FaultKind::kCrash, "fusion", 8, 0);
  const FaultFindings& found = run.run();
  std::set<NodeId> thrown_back;
  for (const auto& state : found.faults.at(0).states) {
    if (state.node == run.node("fusion")) continue;
    thrown_back.insert(state.node);
    EXPECT_TRUE(state.to == "coldstart listen" || state.to == "integration listen" || state.to == "coldstart gap")
        << state.from << " to " << state.to;
  }
  EXPECT_FALSE(thrown_back.empty());
}

// It is also a fault of the node whose slots are silent, but it has done nothing.
TEST(FaultAccount, AFaultThatNeverActsHasNoEffects) {
  Planned run;
  run.add(FaultKind::kCrash, "camera_pre", 1'000, 0);
  run.add(FaultKind::kBabblingIdiot, "camera_pre", 1'200, 100);
  const FaultFindings& found = run.run();
  EXPECT_GT(others(found.faults.at(0), Check::kNoFrame).cycles, 100u);
  EXPECT_EQ(found.faults.at(1).acts, 0u);
  EXPECT_TRUE(found.faults[1].nothing());
  EXPECT_TRUE(found.unattributed.nothing());
}

// A burst is recorded no longer than its fault lasts. A frame is sent to its end, and its effects belong to
// the fault.
TEST(FaultAccount, EffectsOfABurstBelongToItsFault) {
  for (const FaultKind kind : {FaultKind::kNoise, FaultKind::kBabblingIdiot}) {
    Planned run;
    ttf::faults::Fault& fault = run.add(kind, kind == FaultKind::kNoise ? "" : "gateway", 1'000, 1);
    fault.length = Duration::milliseconds(100);
    fault.interval = Duration::milliseconds(100);
    const FaultFindings& found = run.run();
    EXPECT_FALSE(found.faults.at(0).nothing());
    EXPECT_TRUE(found.unattributed.nothing()) << ttf::faults::name_of(kind);
  }
  Planned run;
  ttf::faults::Fault& frame = run.add(FaultKind::kBabblingIdiot, "gateway", 1'000, 0);
  frame.signal = ttf::faults::FaultSignal::kFrame;
  frame.duration = Duration{1};
  const FaultFindings& found = run.run();
  EXPECT_EQ(found.faults.at(0).acts, 2u) << "on both channels, once";
  EXPECT_FALSE(found.faults[0].nothing());
  EXPECT_TRUE(found.unattributed.nothing());
}

// H2: endless noise keeps all nodes from starting.
TEST(FaultAccount, ANodeThatNeverStartsIsHarmed) {
  Planned run("scenarios/cold_start.yaml");
  ttf::faults::Fault& noise = run.add(FaultKind::kNoise, "", 0, 0);
  noise.length = Duration::milliseconds(1);
  noise.interval = Duration{};
  const FaultFindings& found = run.run();
  EXPECT_EQ(harmed_nodes(found.faults.at(0), Harm::kNotStarted), run.on_flexray());
  EXPECT_FALSE(found.unattributed.harmed());
}

// Several simultaneous faults: each effect goes to its own, in any order of beginnings and acts.
TEST(FaultAccount, OfSeveralFaultsEachHasItsOwnReport) {
  Planned run;
  run.add(FaultKind::kCrash, "camera_pre", 1'000, 0);
  run.add(FaultKind::kBitFlipPayload, "gateway", 1'200, 300);
  ttf::faults::Fault& noise = run.add(FaultKind::kNoise, "", 1'200, 300);
  noise.channels = schedules::model::Channels::kA;
  noise.interval = Duration::milliseconds(100);
  run.add(FaultKind::kCrash, "laser_pre", 1'300, 0);
  const FaultFindings& found = run.run();
  ASSERT_EQ(found.faults.size(), 4u);
  const double cycles_to_the_end = (run.drive.scenario.duration - Duration::milliseconds(1'000)).seconds() / 0.005;
  EXPECT_NEAR(static_cast<double>(others(found.faults[0], Check::kNoFrame).cycles), cycles_to_the_end, 2.0);
  EXPECT_EQ(others(found.faults[0], Check::kSyntax).cycles, 0u);
  EXPECT_NEAR(static_cast<double>(others(found.faults[1], Check::kSyntax).cycles), 60.0, 1.0) << "every cycle of 0.3 s";
  EXPECT_LE(others(found.faults[2], Check::kSyntax).cycles + others(found.faults[2], Check::kBoundary).cycles, 6u);
  EXPECT_NEAR(static_cast<double>(others(found.faults[3], Check::kNoFrame).cycles), cycles_to_the_end - 60.0, 2.0);
  EXPECT_LE(others(found.faults[3], Check::kSyntax).cycles, 1u) << "of a frame that breaks off";
  EXPECT_TRUE(found.unattributed.nothing());
}

// Two faults of one node, in consecutive slots: a frame that does not leave is silence, one with inverted
// bits is not.
TEST(FaultAccount, OfTwoFaultsOfOneNodeEachHasItsOwnReport) {
  Planned run;
  run.add(FaultKind::kOmission, "gateway", 1'000, 0).probability = 0.1;
  run.add(FaultKind::kBitFlipPayload, "gateway", 1'000, 0).probability = 0.1;
  const FaultFindings& found = run.run();
  EXPECT_GT(others(found.faults.at(0), Check::kNoFrame).cycles, 100u);
  EXPECT_EQ(others(found.faults[0], Check::kSyntax).cycles, 0u);
  EXPECT_GT(others(found.faults.at(1), Check::kSyntax).cycles, 100u);
  EXPECT_EQ(others(found.faults[1], Check::kNoFrame).cycles, 0u);
  EXPECT_TRUE(found.unattributed.nothing());
}

// The guardians keep a babbling idiot's noise from the others; only they see it.
struct Interventions final : recording::records::Sink {
  using recording::records::Sink::on;
  std::vector<recording::records::GuardianIntervention> seen;
  std::set<std::string> reasons;
  void on(const recording::records::GuardianIntervention& one) override {
    reasons.emplace(one.why);
    seen.push_back(one);
    seen.back().why = {};
  }
};

TEST(FaultAccount, SignalsThatGuardiansBlockAreReported) {
  Planned run;
  run.drive.cluster.topology = schedules::model::Topology::kStar;
  run.drive.cluster.guardian = true;
  ttf::faults::Fault& babble = run.add(FaultKind::kBabblingIdiot, "feature", 1'001, 50);
  babble.channels = schedules::model::Channels::kB;
  babble.interval = Duration::milliseconds(1);
  FaultAccount report = run.make_report();
  Interventions interventions;
  recording::records::Tee tee({&report, &interventions});
  run.drive.run(tee);
  const FaultFindings& found = report.findings();
  const FaultSeen& fault = found.faults.at(0);
  EXPECT_EQ(fault.acts, 50u);
  EXPECT_EQ(interventions.seen.size(), 50u);
  for (const auto& one : interventions.seen) {
    EXPECT_EQ(one.branch, run.node("feature"));
    EXPECT_EQ(one.channel, 1);
    EXPECT_EQ(one.signal, recording::records::GuardedSignal::kUndecodable);
    EXPECT_FALSE(one.cut);
    EXPECT_EQ(one.until, one.at);
  }
  const CheckSeen& guard = others(fault, Check::kGuardian);
  EXPECT_NEAR(static_cast<double>(guard.cycles), 10.0, 1.0);
  EXPECT_FALSE(guard.guardians[0]);
  EXPECT_TRUE(guard.guardians[1]);
  std::uint64_t signals = 0;
  for (const auto& kept : fault.guardians) {
    EXPECT_TRUE(interventions.reasons.count(kept.why)) << kept.why;
    EXPECT_FALSE(kept.cut);
    EXPECT_NEAR(static_cast<double>(kept.first_cycle), 200.0, 10.0);
    signals += kept.signals;
  }
  EXPECT_EQ(fault.guardians.size(), interventions.reasons.size());
  EXPECT_EQ(fault.guardians[0].first_cycle, 200);
  EXPECT_EQ(signals, 50u);
  EXPECT_EQ(others(fault, Check::kSyntax).cycles + others(fault, Check::kBoundary).cycles, 0u);
  EXPECT_FALSE(found.harmed());
  EXPECT_TRUE(found.unattributed.nothing());
}

// A frame that does not end: it goes through as far as one may last.
struct Endless final : sim::medium::Disturbance {
  NodeId sender{};
  TrueTime from{}, to{};
  bool leaving(sim::medium::Leaving& signal) override {
    if (signal.sender == sender && signal.start >= from && signal.start < to) signal.end += Duration::microseconds(200);
    return true;
  }
};

TEST(FaultAccount, SignalsThatGuardiansCutAreReported) {
  sim::drives::Drive drive("scenarios/paper_scenario1.yaml", StrategyKind::kTt);
  drive.cluster.topology = schedules::model::Topology::kStar;
  drive.cluster.guardian = true;
  Interventions interventions;
  const auto scene = std::make_shared<sensors::WorldScene>(drive.scenario.world, 1, 0, sim::engine::kFirstCycle);
  const sim::drives::NodeSetConfig set{&drive.scenario, &drive.cluster, StrategyKind::kTt, 1, 0, scene, nullptr};
  sim::engine::SimulationConfig config;
  config.cluster = &drive.cluster;
  config.seed = 1;
  config.make_steps = [&](NodeId node) { return sim::drives::make_steps(set, node); };
  sim::engine::ClusterSimulation simulation(config, interventions);
  Endless endless;
  endless.sender = *drive.cluster.find_node("laser_pre");
  endless.from = sim::engine::kFirstCycle + drive.cluster.cycle() * 20;
  endless.to = endless.from + drive.cluster.cycle();
  simulation.set_disturbance(&endless);
  simulation.run_until(endless.from - Duration::microseconds(100));
  EXPECT_TRUE(interventions.seen.empty()) << "of a drive without faults guardians have nothing to tell";
  simulation.run_until(endless.to + drive.cluster.cycle());
  std::set<int> channels;
  for (const auto& one : interventions.seen) {
    if (!one.cut) continue;
    channels.insert(one.channel);
    EXPECT_EQ(one.branch, endless.sender);
    EXPECT_EQ(one.signal, recording::records::GuardedSignal::kFrame);
    EXPECT_EQ(one.reason, recording::records::GuardianReason::kForwarded);
    EXPECT_GT(one.until, one.at);
    EXPECT_LT(one.until, one.at + Duration::microseconds(100)) << "a frame of 28 words lasts 66 us";
  }
  EXPECT_EQ(channels, (std::set{0, 1}));
  EXPECT_TRUE(interventions.reasons.count("it lasts longer than its kind may"));
}

// The log gives the same report as the run.
TEST(FaultAccount, IsTheSameFromTheLog) {
  Planned run("scenarios/faulty_bus.yaml");
  run.drive.cluster.topology = schedules::model::Topology::kStar;
  run.drive.cluster.guardian = true;
  FaultAccount live = run.make_report(), logged = run.make_report();
  const std::string path = testing::TempDir() + "/faulty_bus.mcap";
  recording::log::LogWriter log(path, {});
  recording::records::Tee tee({&live, &log});
  run.drive.run(tee);
  log.close();
  recording::log::read_log(path, logged);
  std::filesystem::remove(path);
  for (FaultAccount* report : {&live, &logged}) report->finish(sim::drives::drive_end(run.drive.scenario));
  const FaultFindings &a = live.findings(), &b = logged.findings();
  ASSERT_EQ(a.faults.size(), run.drive.scenario.faults.faults.size());
  ASSERT_EQ(b.faults.size(), a.faults.size());
  std::uint64_t cycles = 0, kept = 0;
  const auto expect_same = [&](const FaultEffects& of_live, const FaultEffects& of_log) {
    EXPECT_EQ(of_live.harmed(), of_log.harmed());
    ASSERT_EQ(of_live.states.size(), of_log.states.size());
    for (std::size_t s = 0; s < of_live.states.size(); ++s) EXPECT_EQ(of_live.states[s].why, of_log.states[s].why);
    ASSERT_EQ(of_live.guardians.size(), of_log.guardians.size());
    for (std::size_t g = 0; g < of_live.guardians.size(); ++g) {
      EXPECT_EQ(of_live.guardians[g].why, of_log.guardians[g].why);
      EXPECT_EQ(of_live.guardians[g].signals, of_log.guardians[g].signals);
      kept += of_live.guardians[g].signals;
    }
    for (std::size_t c = 0; c < of_live.by_others.size(); ++c) {
      EXPECT_EQ(of_live.by_others[c].cycles, of_log.by_others[c].cycles);
      EXPECT_EQ(of_live.by_others[c].nodes, of_log.by_others[c].nodes);
      EXPECT_EQ(of_live.by_faulty[c].cycles, of_log.by_faulty[c].cycles);
      cycles += of_live.by_others[c].cycles;
    }
  };
  for (std::size_t f = 0; f < a.faults.size(); ++f) {
    EXPECT_EQ(a.faults[f].kind, b.faults[f].kind);
    EXPECT_EQ(a.faults[f].text, b.faults[f].text);
    EXPECT_EQ(a.faults[f].acts, b.faults[f].acts);
    EXPECT_EQ(a.faults[f].begins, b.faults[f].begins);
    EXPECT_EQ(a.faults[f].ends, b.faults[f].ends);
    expect_same(a.faults[f], b.faults[f]);
  }
  expect_same(a.unattributed, b.unattributed);
  EXPECT_GT(cycles, 100u);
  EXPECT_GT(kept, 100u);
}

}  // namespace
}  // namespace ttf::evaluation::faults
