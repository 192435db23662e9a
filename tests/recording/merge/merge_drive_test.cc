// Whole drives, recorded by one process or by one per node. After merging, every result made of the logs is
// the same as of the single log.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/file_bytes.h"
#include "evaluation/cluster/startup_account.h"
#include "evaluation/faults/fault_account.h"
#include "recording/exports/captures.h"
#include "recording/merge/merge.h"
#include "report/plots/position_plot.h"
#include "report/startup/diagram.h"
#include "report/timing/diagram.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/merge/split_log.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::recording::merge {
namespace {

using fusion::strategies::StrategyKind;
using sim::drives::Drive;
using Read = std::function<void(ttf::recording::records::Sink&)>;

constexpr TrueTime kNever{-1};

// A drive's results, from its records alone.
std::string reported(const evaluation::accuracy::DriveSummary& s) {
  std::string text = fmt::format("{} {} {} {} {}", s.position_rmse_truth, s.velocity_rmse_truth,
                                 s.position_rmse_reference, s.velocity_rmse_reference, s.reference_compared);
  text += fmt::format(" | {} {} {} {} {} {}", s.matched, s.missed, s.spurious, s.uses, s.stale_uses, s.warnings);
  text += fmt::format(" | {} {} {} {}", s.nees, s.nees_samples, s.nees_low, s.nees_high);
  text += fmt::format(" | {} {} {} {} {} {} {}", s.received, s.out_of_sequence, s.fused, s.fused_late, s.held,
                      s.dropped, s.duplicates);
  const auto add = [&text](const evaluation::accuracy::AgeStatistics& ages) {
    text += fmt::format(" | {} {} {}", ages.count, ages.sum.ns, ages.worst.ns);
  };
  add(s.age_fused);
  add(s.age_used);
  for (const auto& [sensor, ages] : s.age_fused_by_sensor) add(ages);
  for (const auto& [sensor, ages] : s.age_used_by_sensor) add(ages);
  return text;
}

std::string reported(const evaluation::cluster::StartupAccount& account) {
  std::string text;
  for (const evaluation::cluster::NodeStartup& node : account.nodes()) {
    text += fmt::format("{} {} {} {}", index_of(node.node), node.powered.value_or(kNever).ns, node.state, node.why);
    if (node.active)
      text += fmt::format(" active {} {} {} {}", node.active->at.ns, node.active->cycle, node.active->from,
                          node.active->why);
    text += '\n';
  }
  return text;
}

std::string reported(const evaluation::faults::FaultEffects& effects) {
  std::string text;
  for (const auto& checks : {effects.by_others, effects.by_faulty})
    for (const evaluation::faults::CheckSeen& check : checks) {
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

std::string reported(const evaluation::faults::FaultFindings& findings) {
  std::string text;
  for (const evaluation::faults::FaultSeen& seen : findings.faults)
    text += fmt::format("{} {} {} {} {} {} {} {}:{}\n", seen.fault, seen.kind, index_of(seen.node), seen.begins->ns,
                        seen.ends.value_or(kNever).ns, seen.first_act.value_or(kNever).ns, seen.acts, seen.text,
                        reported(static_cast<const evaluation::faults::FaultEffects&>(seen)));
  return text + "unattributed:" + reported(findings.unattributed);
}

struct Outcome {
  std::string measures, startup, faults, timing, startup_picture, plane, over_time, pcapng, candump, csv;
};

Outcome outcome(const Drive& drive, const log::LogManifest& manifest, const Read& read) {
  evaluation::accuracy::DriveMeasures measures(sim::drives::evaluation_start(drive.scenario));
  evaluation::cluster::StartupAccount startup(drive.cluster.cycle());
  evaluation::faults::FaultAccount faults(drive.cluster, faults::resolve(drive.scenario.faults, drive.cluster),
                                          !drive.scenario.startup.cold);
  const report::drawing::Names names = report::drawing::names_of(drive.cluster);
  const TrueTime from = sim::drives::evaluation_start(drive.scenario), to = sim::drives::drive_end(drive.scenario);
  report::timing::TimingDiagram timing(names, drive.cluster.cycle(), from, from + Duration::milliseconds(160));
  report::startup::StartupDiagram startup_picture(names, drive.cluster.cycle(), TrueTime{},
                                                  TrueTime{} + Duration::milliseconds(300));
  report::plots::PositionPlots positions(names, {"", from, to});
  exports::FrameCollector frames;
  records::Tee tee({&measures, &startup, &faults, &timing, &startup_picture, &positions, &frames});
  read(tee);
  faults.finish(to);
  const exports::LogNames log_names(manifest);
  return {reported(measures.finish()),
          reported(startup),
          reported(faults.findings()),
          timing.svg(),
          startup_picture.svg(),
          positions.plane_svg(),
          positions.over_time_svg(),
          export_pcapng(frames, frames.in_order(), log_names),
          export_candump(frames, frames.in_order(), log_names),
          export_csv(frames, frames.in_order(), log_names)};
}

// EXPECT_EQ would print a megabyte.
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
  log::LogManifest manifest = log::sample_manifest();
  for (const schedules::model::PduLayout& pdu : drive.cluster.pdus) manifest.pdu_sensors.push_back(pdu.sensor);
  const std::string path = log::scratch("drive.mcap");
  std::string stated;
  {
    log::LogWriter writer(path, manifest);
    drive.run(writer);
    writer.close();
    stated = writer.content_hash_text();
  }
  const std::string folder = log::scratch("split");
  std::filesystem::create_directories(folder);
  const std::vector<std::string> paths = split_log(path, folder, drive.cluster.nodes.size());
  const MergedLogs one(std::vector<std::string>{path}), many(paths);
  EXPECT_EQ(one.warnings(), std::vector<std::string>{});
  EXPECT_EQ(many.warnings(), std::vector<std::string>{});
  EXPECT_EQ(log::ContentHash::text(many.content_hash().value()), stated);

  const Outcome raw = outcome(drive, manifest, [&](records::Sink& sink) { log::read_log(path, sink); });
  expect_same(outcome(drive, manifest, [&](records::Sink& sink) { one.read(sink); }), raw, "the log, merged alone");
  expect_same(outcome(drive, manifest, [&](records::Sink& sink) { many.read(sink); }), raw, "the nodes' logs, merged");

  write_merged(one, log::scratch("one.mcap"));
  write_merged(many, log::scratch("many.mcap"));
  EXPECT_TRUE(read_file(log::scratch("one.mcap")) == read_file(log::scratch("many.mcap")));
  records::Sink nobody;
  const log::LogInfo info = log::read_log(log::scratch("many.mcap"), nobody);
  EXPECT_EQ(info.warning, "");
  EXPECT_EQ(log::ContentHash::text(info.content_hash), stated);
}

TEST(MergeDrive, WithEveryStrategy) {
  for (const StrategyKind strategy : fusion::strategies::kAllStrategies)
    compare("scenarios/paper_scenario1.yaml", strategy);
}
TEST(MergeDrive, ThatBeginsWithAStartUp) { compare("scenarios/cold_start.yaml", StrategyKind::kTt); }
TEST(MergeDrive, WithFaults) { compare("scenarios/faulty_bus.yaml", StrategyKind::kTt); }

}  // namespace
}  // namespace ttf::recording::merge
