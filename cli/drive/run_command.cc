#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/drive_setup.h"
#include "cli/drive/fault_tables.h"
#include "cli/drive/recording_outputs.h"
#include "cli/drive/run_outputs.h"
#include "cli/drive/startup_outputs.h"
#include "cli/output.h"
#include "cli/shipped.h"
#include "core/errors.h"
#include "drives/step_catalog.h"
#include "recording/log/writer.h"
#include "recording/records/tee.h"

namespace ttf::cli::drive {
namespace {

struct RunOptions {
  std::string scenario;
  std::string strategy;
  std::optional<std::string> seed;
  std::string input;
  std::string out;
  bool json = false;
  bool no_log = false;
  bool no_pictures = false;
};

StrategyResult run_strategy(const RunOptions& options, const drives::Scenario& scenario,
                            fusion::strategies::StrategyKind strategy, std::uint64_t seed, const Recording& recording,
                            const std::string& folder) {
  StrategyResult result;
  result.strategy = strategy;
  result.cluster = checked_cluster(scenario, strategy);
  std::optional<TrueTime> until;
  if (recording.rows) {
    result.recording = drives::recording_use(scenario, result.cluster, *recording.rows);
    until = result.recording->end;
  }
  DriveJudge judge(scenario, result.cluster, until);
  std::vector<recording::records::Sink*> sinks = judge.sinks();
  TrackWatch tracks;
  if (recording.rows) sinks.push_back(&tracks);
  std::unique_ptr<recording::log::LogWriter> log;
  if (!options.no_log) {
    result.log_path = fmt::format("{}/{}.mcap", folder, name_of(strategy));
    if (!options.input.empty()) refuse_overwriting(options.input, result.log_path, "--out");
    log = begin_log(result.log_path, manifest_of(scenario, result.cluster, strategy, seed, recording), scenario,
                    result.cluster);
    sinks.push_back(log.get());
  }
  recording::records::Tee tee(sinks);
  const drives::DriveConfig config{&scenario, &result.cluster, strategy, seed, 0, recording.rows};
  result.outcome = drives::run_drive(config, tee);
  judge.finish(result);
  result.made_track = tracks.any();
  if (log) {
    log->close();
    result.content_hash = log->content_hash_text();
  }
  return result;
}

int run_scenario(const RunOptions& options) {
  const drives::Scenario scenario = drives::load_scenario(options.scenario);
  const std::uint64_t seed = options.seed ? seed_of(*options.seed) : scenario.seed;
  const Recording recording = read_recording(options.input);
  const std::string folder = options.out.empty() ? folder_of(scenario) : options.out;
  // Checks the input before any simulation, and before an earlier log is overwritten.
  for (const fusion::strategies::StrategyKind strategy : chosen(options.strategy)) {
    const schedules::model::Cluster cluster = checked_cluster(scenario, strategy);
    drives::check_fits(scenario, cluster, strategy, recording.rows != nullptr);
    if (recording.rows) (void)drives::recording_use(scenario, cluster, *recording.rows);
  }
  create_folder(folder);

  std::vector<StrategyResult> results;
  for (const fusion::strategies::StrategyKind strategy : chosen(options.strategy)) {
    fmt::print(stderr, "{}: {:g} s with {} ...\n", scenario.name, scenario.duration.seconds(), name_of(strategy));
    results.push_back(run_strategy(options, scenario, strategy, seed, recording, folder));
  }
  if (!options.no_pictures && !options.no_log) write_pictures(scenario, results, folder);
  const nlohmann::ordered_json json = to_json(scenario, seed, results);
  write_file(folder + "/summary.json", json.dump(2) + '\n');
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}\n{}{}{}", scenario.description, recordings_text(results),
               startup_text(results, scenario.startup.cold), comparison_table(results));
    if (!scenario.faults.empty())
      for (const StrategyResult& result : results)
        fmt::print("\n{}", faults_text(name_of(result.strategy), result.faults, result.fault_free, result.cluster));
  }
  std::fflush(stdout);  // both streams may share one file
  say_written(folder);
  bool did_its_work = true;
  for (const StrategyResult& result : results) {
    if (const std::string sentence = never_started(result, scenario.startup.cold); !sentence.empty()) {
      fmt::print(stderr, "error: {}\n", sentence);
      did_its_work = false;
    }
    const std::string headline = fmt::format("with {}", name_of(result.strategy));
    if (print_reasons(options.input, headline, recording_reasons(result, scenario.tracker)) != 0) did_its_work = false;
  }
  return did_its_work ? 0 : 1;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "One drive in virtual time: log, summary table and pictures");
  command->footer("Example: ttfusion run scenarios/paper_scenario1.yaml --seed 7 --out out/drive");
  command->add_option("scenario", options->scenario, "Scenario file, or a shipped one's name")->required();
  command->add_option("--strategy", options->strategy, "Only this strategy (default: all three)")
      ->check(one_of(strategy_names()));
  command->add_option("--seed", options->seed, "Seed of every random stream, instead of the scenario's");
  command->add_option("--input", options->input, "Recorded observations in place of the sensor models")->check(named());
  command->add_option("--out", options->out, "Folder for logs and pictures (default: out/<scenario>)")->check(named());
  command->add_flag("--json", options->json, "Summary as JSON on standard output");
  command->add_flag("--no-log", options->no_log, "Write no logs (and so no pictures)");
  command->add_flag("--no-pictures", options->no_pictures, "Write logs only");
  command->callback([options, &action] {
    action = [options] {
      options->scenario = file_named(options->scenario, {kScenarios});
      return run_scenario(*options);
    };
  });
}

}  // namespace ttf::cli::drive
