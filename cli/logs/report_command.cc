#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/step_options.h"
#include "cli/experiment/drives.h"
#include "cli/logs/attached.h"
#include "cli/logs/viewed_sensors.h"
#include "cli/output.h"
#include "cli/time_window.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "core/time.h"
#include "evaluation/ages/stage_account.h"
#include "experiments/sweep/file.h"
#include "fusion/strategies/strategy.h"
#include "recording/merge/merge.h"
#include "recording/merge/stored_log.h"
#include "report/drive/report.h"
#include "report/drive/stages.h"
#include "report/experiment/report.h"
#include "schedules/analysis/ages.h"
#include "schedules/check/checker.h"
#include "sim/drives/drive.h"

namespace ttf::cli::logs {
namespace {

using report::drive::ReportedDurations;
using report::drive::ReportedStage;
using report::drive::ReportedStages;

ReportedDurations reported(const evaluation::ages::DurationStatistics& had) {
  return {in_ms(had.least), in_ms(had.mean()), in_ms(had.p99()), in_ms(had.most)};
}

std::optional<double> reported(const std::optional<Duration>& bound) {
  return bound ? std::optional(in_ms(*bound)) : std::nullopt;
}

// The latency by stage of a drive, from its log and the attached cluster. Returns nothing if the log has no sound cluster; a
// warning names one that cannot be read.
std::vector<ReportedStages> reported_stages(const recording::merge::MergedLogs& drive,
                                            std::vector<std::string>& warnings) {
  const Attached attached = attached_to(drive, "the latency by stage is left out", warnings);
  if (!attached.cluster || !schedules::check::check(*attached.cluster).empty()) return {};
  const bool held = drive.manifest().strategy == name_of(fusion::strategies::StrategyKind::kBuff);
  const TrueTime from = attached.scenario ? sim::drives::evaluation_start(*attached.scenario) : TrueTime{};
  evaluation::ages::StageAccount account(schedules::analysis::measurement_ages(*attached.cluster), held, from);
  drive.read(account);
  std::vector<ReportedStages> all;
  for (const evaluation::ages::SensorStages& sensor : account.finish()) {
    ReportedStages& one = all.emplace_back();
    one.sensor = attached.cluster->sensor(sensor.sensor).name;
    one.measured = sensor.measured;
    one.seen = sensor.seen();
    one.to_use = sensor.to_use;
    for (const evaluation::ages::StageFinding& stage : sensor.stages)
      one.stages.push_back({stage.name, reported(stage.best), reported(stage.worst), reported(stage.had),
                            in_ms(stage.age_best), reported(stage.age_worst), reported(stage.age), stage.beyond});
  }
  return all;
}

struct ReportOptions {
  std::vector<std::string> folders;
  TimeWindowOptions window;
  std::optional<std::string> file;
  std::optional<std::uint32_t> point;
  drive::StepOptions steps;
  bool no_drives = false;
  std::string out;
};

constexpr std::size_t kMostDrives = 10;                   // an experiment's with timing diagrams
constexpr Duration kDrawn = Duration::milliseconds(960);  // all of them together, at most 160 ms each

// Adds what the descriptions attached to the logs state: the sensors' places, and the bounds of ages.
void describe(std::vector<report::drive::Drive>& drives) {
  std::vector<std::string> warnings;
  for (report::drive::Drive& drive : drives) {
    if (!drive.log) continue;
    drive.sensors = viewed_sensors(*drive.log, warnings);
    drive.stages = reported_stages(*drive.log, warnings);
  }
  print_warnings(warnings);
}

std::string experiment_html(const ReportOptions& options, report::drive::DiagramWindow window) {
  const report::experiment::ExperimentFolder folder = report::experiment::read_experiment_folder(options.folders[0]);
  report::experiment::ExperimentDrives drives;
  const std::optional<nodes::foreign::StepFolder> steps = drive::step_folder(options.steps);
  if (!options.no_drives) drives = experiment::drives_of(folder, options.file, options.point, drive::pointer_to(steps));
  describe(drives.drives);
  if (!drives.why_none.empty()) print_warnings(drives.why_none);
  window.most = kMostDrives;
  const auto shown = static_cast<std::int64_t>(std::clamp(drives.drives.size(), std::size_t{1}, kMostDrives));
  window.length = std::min(window.length, Duration{kDrawn.ns / shown});
  return report::experiment::experiment_report_html(folder, drives, window);
}

bool is_mcap(const std::string& path) {
  try {
    return kind_of_file(path) == FileKind::kLog;
  } catch (const InputError&) {
    return false;  // neither readable nor YAML
  }
}

// A log's folder has all that a report shows of it.
void refuse_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return;
  if (is_mcap(path)) {
    (void)recording::merge::StoredLog(path);  // refuses an MCAP file that is no log
    const fs::path folder = fs::path(path).parent_path();
    throw InputError({path, 0, "", "",
                      fmt::format("this is a log, not a folder of results; `ttfusion report {}` takes its folder",
                                  folder.empty() ? "." : folder.string())});
  }
  refuse_any_kind(path, "a folder of results");
}

std::string html(const ReportOptions& options) {
  const TimeWindow asked = time_window(options.window);
  report::drive::DiagramWindow window;
  window.from = asked.from;
  window.to = asked.to;
  std::size_t experiments = 0;
  for (const std::string& folder : options.folders) refuse_file(folder);
  for (const std::string& folder : options.folders)
    experiments += report::drive::kind_of_folder(folder) == report::drive::FolderKind::kExperiment;
  if (experiments == 0) {
    for (const auto& [name, given] :
         {std::pair("--file", options.file.has_value()), std::pair("--point", options.point.has_value()),
          std::pair("--steps", options.steps.folder.has_value()),
          std::pair("--step-limit", options.steps.limit.has_value()), std::pair("--no-drives", options.no_drives)})
      if (given) throw InputError({"command line", 0, name, "", "goes with an experiment, not with runs"});
    std::vector<report::drive::ResultsFolder> folders;
    for (const std::string& path : options.folders) {
      folders.push_back(report::drive::read_results_folder(path));
      describe(folders.back().drives);
      for (const report::drive::Drive& drive : folders.back().drives)
        if (drive.log) print_warnings(drive.log->warnings());
    }
    return report::drive::drive_report_html(std::move(folders), window);
  }
  if (options.folders.size() > 1)
    throw InputError({"command line", 0, "folders", options.folders[0],
                      "must be one experiment, or only runs: a report has one experiment at most"});
  return experiment_html(options, window);
}

// The page must not overwrite its own input; an older page may be overwritten.
void refuse_input(const ReportOptions& options) {
  namespace fs = std::filesystem;
  std::error_code none;
  for (const std::string& folder : options.folders)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
      if (entry.is_regular_file(none) && entry.path().extension() != ".html")
        refuse_overwriting(entry.path().string(), options.out, "--out");
}

int run_report(const ReportOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".html")
    throw InputError({"command line", 0, "--out", options.out, "must end in .html: a report is one HTML page"});
  refuse_input(options);
  const std::string page = html(options);
  write_file(options.out, page);
  say_written(options.out, fmt::format("{:.1f} MB", static_cast<double>(page.size()) * 1e-6));
  return 0;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "One HTML page of a run, of several side by side, or of an experiment");
  command->footer(
      "The page needs no network and no other file.\n"
      "Examples: ttfusion report out/drive -o out/drive.html\n"
      "          ttfusion report out/seed1 out/seed2 out/seed3 -o out/drives.html\n"
      "          ttfusion report out/noise -o out/noise.html\n"
      "          ttfusion report out/noise --point 3 -o out/point3.html");
  command->add_option("folders", options->folders, "Folders of results, from --out of run, launch or experiment")
      ->required()
      ->check(named());
  add_time_window(*command, options->window,
                  "Start of the timing diagrams' first window, in true time (default: the begin of the judged part)",
                  "End of the timing diagrams' first window (default: 160 ms later; 2 s later at most)");
  auto* file = command->add_option("--file", options->file,
                                   "An experiment's file, if it has moved: a run of each paradigm is driven again");
  auto* point =
      command->add_option("--point", options->point, "Point of an experiment to drive again (default: the first)")
          ->check(whole_number({0, experiments::sweep::kMostPoints - 1}));
  auto* none = command->add_flag("--no-drives", options->no_drives, "Drive nothing again: no timing diagrams");
  none->excludes(file)->excludes(point);
  drive::add_step_options(*command, options->steps);
  command->add_option("-o,--out", options->out, "The page to write, .html")->required()->check(named());
  command->callback([options, &action] { action = [options] { return run_report(*options); }; });
}

}  // namespace ttf::cli::logs
