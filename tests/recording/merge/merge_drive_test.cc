// Whole drives, recorded by one process or by one per node: merged, everything that is made of the logs is the same,
// and what it was before anything was merged.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/file_bytes.h"
#include "evaluation/faults/fault_account.h"
#include "evaluation/cluster/startup_account.h"
#include "recording/exports/captures.h"
#include "recording/merge/merge.h"
#include "report/plots/position_plot.h"
#include "report/startup/diagram.h"
#include "report/timing/diagram.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/merge/split_log.h"
#include "tests/drives/drive_fixture.h"

namespace ttf::recording {
namespace {

using fusion::StrategyKind;
using testing_support::Drive;
using Read = std::function<void(records::Sink&)>;

constexpr TrueTime kNever{-1};

// What is told of a drive, from its records alone.
std::string told(const experiments::DriveSummary& s) {
  std::string text = fmt::format("{} {} {} {} {}", s.position_rmse_truth, s.velocity_rmse_truth,
                                 s.position_rmse_reference, s.velocity_rmse_reference, s.reference_compared);
  text += fmt::format(" | {} {} {} {} {} {}", s.matched, s.missed, s.spurious, s.uses, s.stale_uses, s.warnings);
  text += fmt::format(" | {} {} {} {}", s.nees, s.nees_samples, s.nees_low, s.nees_high);
  text += fmt::format(" | {} {} {} {} {} {} {}", s.received, s.out_of_sequence, s.fused, s.fused_late, s.held,
                      s.dropped, s.duplicates);
  const auto add = [&text](const experiments::AgeStatistics& ages) {
    text += fmt::format(" | {} {} {}", ages.count, ages.sum.ns, ages.worst.ns);
  };
  add(s.age_fused);
  add(s.age_used);
  for (const auto& [sensor, ages] : s.age_fused_by_sensor) add(ages);
  for (const auto& [sensor, ages] : s.age_used_by_sensor) add(ages);
  return text;
}

std::string told(const experiments::StartupAccount& account) {
  std::string text;
  for (const experiments::NodeStartup& node : account.nodes()) {
    text += fmt::format("{} {} {} {}", index_of(node.node), node.powered.value_or(kNever).ns, node.state, node.why);
    if (node.active)
      text += fmt::format(" active {} {} {} {}", node.active->at.ns, node.active->cycle, node.active->from,
                          node.active->why);
    text += '\n';
  }
  return text;
}

std::string told(const experiments::FaultEffects& effects) {
  std::string text;
  for (const auto& checks : {effects.by_others, effects.by_faulty})
    for (const experiments::CheckSeen& check : checks) {
      text += fmt::format(" c {} {} {}{}", check.cycles, check.first.ns, check.guardians[0], check.guardians[1]);
      for (const NodeId node : check.nodes) text += fmt::format(",{}", index_of(node));
    }
  for (const auto& kept : effects.guardians)
    text += fmt::format(" g {} {} {} {} {}", kept.cut, kept.why, kept.signals, kept.first_cycle, kept.first.ns);
  for (const auto& state : effects.states)
    text += fmt::format(" s {} {} {} {} {} {}", index_of(state.node), state.from, state.to, state.why, state.first.ns,
                        state.times);
  for (const auto& kind : effects.harms)
    for (const auto& harm : kind)
      text += fmt::format(" h {} {} {} {} {}", index_of(harm.node), harm.first.ns, index_of(harm.sender), harm.slot,
                          harm.times);
  return text;
}

std::string told(const experiments::FaultFindings& findings) {
  std::string text;
  for (const experiments::FaultSeen& seen : findings.faults)
    text += fmt::format("{} {} {} {} {} {} {} {}:{}\n", seen.fault, seen.kind, index_of(seen.node), seen.begins.ns,
                        seen.ends.value_or(kNever).ns, seen.first_act.value_or(kNever).ns, seen.acts, seen.text,
                        told(static_cast<const experiments::FaultEffects&>(seen)));
  return text + "unattributed:" + told(findings.unattributed);
}

struct Outcome {
  std::string measures, startup, faults, timing, startup_picture, plane, over_time, pcapng, candump, csv;
};

Outcome outcome(const Drive& drive, const LogManifest& manifest, const Read& read) {
  experiments::DriveMeasures measures(sim::evaluation_start(drive.scenario));
  experiments::StartupAccount startup(drive.cluster.cycle());
  experiments::FaultReport faults(drive.cluster, nodes::resolve(drive.scenario.faults, drive.cluster),
                                  !drive.scenario.startup.cold);
  const report::Names names = report::names_of(drive.cluster);
  const TrueTime from = sim::evaluation_start(drive.scenario), to = sim::drive_end(drive.scenario);
  report::TimingDiagram timing(names, drive.cluster.cycle(), from, from + Duration::milliseconds(160));
  report::StartupDiagram startup_picture(names, drive.cluster.cycle(), TrueTime{},
                                         TrueTime{} + Duration::milliseconds(300));
  report::PositionPlots positions(names, {"", from, to});
  FrameCollector frames;
  records::Tee tee({&measures, &startup, &faults, &timing, &startup_picture, &positions, &frames});
  read(tee);
  faults.finish(to);
  const LogNames log_names(manifest);
  return {told(measures.finish()),
          told(startup),
          told(faults.findings()),
          timing.svg(),
          startup_picture.svg(),
          positions.plane_svg(),
          positions.over_time_svg(),
          export_pcapng(frames, frames.in_order(), log_names),
          export_candump(frames, frames.in_order(), log_names),
          export_csv(frames, frames.in_order(), log_names)};
}

// Not EXPECT_EQ: nobody wants to see a megabyte.
void expect_same(const Outcome& a, const Outcome& b, const std::string& what) {
  EXPECT_EQ(a.measures, b.measures) << what;
  EXPECT_EQ(a.startup, b.startup) << what;
  EXPECT_EQ(a.faults, b.faults) << what;
  EXPECT_TRUE(a.timing == b.timing) << what;
  EXPECT_TRUE(a.startup_picture == b.startup_picture) << what;
  EXPECT_TRUE(a.plane == b.plane) << what;
  EXPECT_TRUE(a.over_time == b.over_time) << what;
  EXPECT_TRUE(a.pcapng == b.pcapng) << what;
  EXPECT_TRUE(a.candump == b.candump) << what;
  EXPECT_TRUE(a.csv == b.csv) << what;
}

void compare(const char* scenario, StrategyKind strategy) {
  const Drive drive(scenario, strategy);
  LogManifest manifest = sample_manifest();
  for (const schedules::PduLayout& pdu : drive.cluster.pdus) manifest.pdu_sensors.push_back(pdu.sensor);
  const std::string path = scratch("drive.mcap");
  std::string stated;
  {
    LogWriter writer(path, manifest);
    drive.run(writer);
    writer.close();
    stated = writer.content_hash_text();
  }
  const std::string folder = scratch("split");
  std::filesystem::create_directories(folder);
  const std::vector<std::string> paths = split_log(path, folder, drive.cluster.nodes.size());
  const MergedLogs one(std::vector<std::string>{path}), many(paths);
  EXPECT_EQ(one.warnings(), std::vector<std::string>{});
  EXPECT_EQ(many.warnings(), std::vector<std::string>{});
  EXPECT_EQ(ContentHash::text(many.content_hash().value()), stated);

  const Outcome raw = outcome(drive, manifest, [&](records::Sink& sink) { read_log(path, sink); });
  expect_same(outcome(drive, manifest, [&](records::Sink& sink) { one.read(sink); }), raw, "the log, merged alone");
  expect_same(outcome(drive, manifest, [&](records::Sink& sink) { many.read(sink); }), raw, "the nodes' logs, merged");

  write_merged(one, scratch("one.mcap"));
  write_merged(many, scratch("many.mcap"));
  EXPECT_TRUE(read_file(scratch("one.mcap")) == read_file(scratch("many.mcap")));
  records::Sink nobody;
  const LogInfo info = read_log(scratch("many.mcap"), nobody);
  EXPECT_EQ(info.warning, "");
  EXPECT_EQ(ContentHash::text(info.content_hash), stated);
}

TEST(MergeDrive, WithEveryStrategy) {
  for (const StrategyKind strategy : testing_support::kStrategies) compare("scenarios/paper_scenario1.yaml", strategy);
}
TEST(MergeDrive, ThatBeginsWithAStartUp) { compare("scenarios/cold_start.yaml", StrategyKind::kTt); }
TEST(MergeDrive, WithFaults) { compare("scenarios/faulty_bus.yaml", StrategyKind::kTt); }

}  // namespace
}  // namespace ttf::recording
