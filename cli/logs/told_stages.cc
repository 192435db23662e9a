#include "cli/logs/told_stages.h"

#include "cli/logs/attached.h"
#include "evaluation/ages/stage_account.h"
#include "fusion/strategies/strategy.h"
#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "sim/drives/drive.h"

namespace ttf::cli::logs {
namespace {

using report::drive::ToldDurations;
using report::drive::ToldStage;
using report::drive::ToldStages;

ToldDurations told(const evaluation::ages::DurationStatistics& had) {
  return {in_ms(had.least), in_ms(had.mean()), in_ms(had.p99()), in_ms(had.most)};
}

std::optional<double> told(const std::optional<Duration>& bound) {
  return bound ? std::optional(in_ms(*bound)) : std::nullopt;
}

}  // namespace

std::vector<ToldStages> told_stages(const recording::merge::MergedLogs& drive, std::vector<std::string>& warnings) {
  const Attached attached = attached_to(drive, "the latency by stage is left out", warnings);
  if (!attached.cluster || !schedules::check::check(*attached.cluster).empty()) return {};
  const bool held = drive.manifest().strategy == name_of(fusion::strategies::StrategyKind::kBuff);
  const TrueTime from = attached.scenario ? sim::drives::evaluation_start(*attached.scenario) : TrueTime{};
  evaluation::ages::StageAccount account(schedules::analysis::measurement_ages(*attached.cluster), held, from);
  drive.read(account);
  std::vector<ToldStages> all;
  for (const evaluation::ages::SensorStages& sensor : account.finish()) {
    ToldStages& one = all.emplace_back();
    one.sensor = attached.cluster->sensor(sensor.sensor).name;
    one.measured = sensor.measured;
    one.seen = sensor.seen();
    one.to_use = sensor.to_use;
    for (const evaluation::ages::StageFinding& stage : sensor.stages)
      one.stages.push_back({stage.name, told(stage.best), told(stage.worst), told(stage.had), in_ms(stage.age_best),
                            told(stage.age_worst), told(stage.age), stage.beyond});
  }
  return all;
}

}  // namespace ttf::cli::logs
