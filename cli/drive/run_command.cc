#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/drive_setup.h"
#include "cli/drive/fault_tables.h"
#include "cli/drive/recording_outputs.h"
#include "cli/drive/run_outputs.h"
#include "cli/drive/startup_outputs.h"
#include "cli/drive/step_options.h"
#include "cli/drive/summary.h"
#include "cli/drive_progress.h"
#include "cli/output.h"
#include "cli/shipped.h"
#include "core/errors.h"
#include "recording/log/writer.h"
#include "recording/records/tee.h"
#include "sim/drives/step_catalog.h"
#include "sim/drives/surroundings.h"
#include "sim/drives/traced.h"

namespace ttf::cli::drive {
namespace {

struct RunOptions {
  std::vector<std::string> scenarios;
  std::string strategy;
  std::optional<std::string> seed, duration;
  std::string input, truth;
  std::string out;
  StepOptions steps;
  bool json = false;
  bool no_log = false;
  bool no_pictures = false;
};

StrategyResult run_strategy(const RunOptions& options, const sim::drives::Scenario& scenario,
                            fusion::strategies::StrategyKind strategy, std::uint64_t seed, const Recording& recording,
                            const std::string& folder, const nodes::foreign::StepFolder* steps) {
  StrategyResult result;
  result.strategy = strategy;
  result.cluster = checked_cluster(scenario, strategy);
  std::optional<TrueTime> until;
  if (recording.rows) {
    result.recording = sim::drives::recording_use(scenario, result.cluster, *recording.rows);
    until = result.recording->end;
  }
  DriveJudge judge(scenario, result.cluster, strategy, until);
  std::vector<recording::records::Sink*> sinks = judge.sinks();
  TrackWatch tracks;
  if (recording.rows) sinks.push_back(&tracks);
  std::unique_ptr<recording::log::LogWriter> log;
  if (!options.no_log) {
    result.log_path = fmt::format("{}/{}.mcap", folder, name_of(strategy));
    for (const std::string& read : {options.input, options.truth})
      if (!read.empty()) refuse_overwriting(read, result.log_path, "--out");
    log = begin_log(result.log_path, manifest_of(scenario, result.cluster, strategy, seed, recording, steps), scenario,
                    result.cluster);
    sinks.push_back(log.get());
  }
  DriveProgress progress(until ? *until : sim::drives::drive_end(scenario), "driven");
  sinks.push_back(&progress);
  recording::records::Tee tee(sinks);
  sim::drives::DriveConfig config{&scenario, &result.cluster, strategy, seed, 0, recording.rows};
  config.steps = steps;
  result.outcome = sim::drives::run_drive(config, tee);
  judge.finish(result);
  result.made_track = tracks.any();
  if (log) {
    log->close();
    result.content_hash = log->content_hash_text();
  }
  return result;
}

// A scenario to drive, checked.
struct Planned {
  sim::drives::Scenario scenario;
  std::uint64_t seed = 0;
  std::string folder;
};

// Checks the input before any simulation, and before an earlier log is overwritten.
Planned planned(const RunOptions& options, const std::string& file, const Recording& recording,
                const std::shared_ptr<const recording::osi::TruthTrace>& truth,
                const nodes::foreign::StepFolder* steps) {
  Planned plan;
  plan.scenario = sim::drives::load_scenario(file);
  plan.seed = options.seed ? seed_of(*options.seed) : plan.scenario.seed;
  if (options.duration) set_duration(plan.scenario, file, *options.duration);
  if (truth) sim::drives::take_truth(plan.scenario, truth);
  const bool alone = options.scenarios.size() == 1;
  if (options.out.empty())
    plan.folder = folder_of(plan.scenario);
  else
    plan.folder = alone ? options.out : options.out + "/" + named_folder(plan.scenario);
  std::string warning;
  std::vector<schedules::model::Cluster> clusters;
  for (const fusion::strategies::StrategyKind strategy : chosen(options.strategy)) {
    const schedules::model::Cluster& cluster = clusters.emplace_back(checked_cluster(plan.scenario, strategy));
    if (warning.empty()) warning = sim::drives::motion_warning(plan.scenario, cluster);
    sim::drives::check_fits(plan.scenario, cluster, strategy, recording.rows != nullptr);
    nodes::foreign::check_steps(cluster, steps);
    if (recording.rows) (void)sim::drives::recording_use(plan.scenario, cluster, *recording.rows);
  }
  for (const std::string& one :
       {warning, sim::drives::following_warning(plan.scenario), sim::drives::unused_sections(plan.scenario, clusters)})
    if (!one.empty()) print_warnings(one);
  return plan;
}

std::vector<Planned> all_planned(const RunOptions& options, const Recording& recording,
                                 const std::shared_ptr<const recording::osi::TruthTrace>& truth,
                                 const nodes::foreign::StepFolder* steps) {
  std::vector<Planned> plans;
  for (const std::string& file : options.scenarios) {
    Planned plan = planned(options, file, recording, truth, steps);
    const auto same = std::ranges::find(plans, plan.folder, &Planned::folder);
    if (same != plans.end())
      throw InputError(
          {file, 0, "name", plan.scenario.name,
           fmt::format("must differ from that of {}: each has a folder of its name", same->scenario.file)});
    plans.push_back(std::move(plan));
  }
  return plans;
}

// Drives one scenario with each strategy, and writes its folder.
std::vector<StrategyResult> driven(const RunOptions& options, const Planned& plan, const Recording& recording,
                                   const nodes::foreign::StepFolder* steps) {
  create_folder(plan.folder);
  if (plan.scenario.truth) fmt::print(stderr, "{}: {}\n", plan.scenario.name, sim::drives::truth_text(plan.scenario));
  std::vector<StrategyResult> results;
  for (const fusion::strategies::StrategyKind strategy : chosen(options.strategy)) {
    fmt::print(stderr, "{}: {:g} s with {} ...\n", plan.scenario.name, plan.scenario.duration.seconds(),
               name_of(strategy));
    results.push_back(run_strategy(options, plan.scenario, strategy, plan.seed, recording, plan.folder, steps));
  }
  if (!options.no_pictures && !options.no_log) write_pictures(plan.scenario, results, plan.folder);
  write_file(plan.folder + "/summary.json", to_json(plan.scenario, plan.seed, results).dump(2) + '\n');
  return results;
}

void print_words(const std::vector<Planned>& plans, const std::vector<ScenarioResults>& all) {
  for (std::size_t s = 0; s < plans.size(); ++s) {
    const sim::drives::Scenario& scenario = plans[s].scenario;
    fmt::print("{}{}\n{}{}", plans.size() > 1 ? scenario.name + ": " : "", sim::drives::subject_of(scenario),
               recordings_text(all[s].results), startup_text(all[s].results, scenario.startup.cold));
  }
  fmt::print("{}", comparison_table(all));
  for (std::size_t s = 0; s < plans.size(); ++s) {
    if (plans[s].scenario.faults.empty()) continue;
    for (const StrategyResult& result : all[s].results)
      fmt::print("\n{}{}", plans.size() > 1 ? plans[s].scenario.name + ", " : "",
                 faults_text(name_of(result.strategy), result.faults, result.fault_free, result.cluster));
  }
}

// Prints the reasons why drives did not do their work. Returns whether all did.
bool did_its_work(const RunOptions& options, const Planned& plan, const std::vector<StrategyResult>& results) {
  bool all = true;
  for (const StrategyResult& result : results) {
    if (const std::string sentence = never_started(result, plan.scenario.startup.cold); !sentence.empty()) {
      fmt::print(stderr, "error: {}{}\n", options.scenarios.size() > 1 ? plan.scenario.name + ": " : "", sentence);
      all = false;
    }
    const std::string headline = fmt::format("with {}", name_of(result.strategy));
    if (print_reasons(options.input, headline, recording_reasons(result, plan.scenario.tracker)) != 0) all = false;
  }
  return all;
}

int run_scenarios(const RunOptions& options) {
  if (!options.input.empty() && options.scenarios.size() > 1)
    throw InputError({"command line", 0, "--input", options.input, "goes with one scenario"});
  if (!options.input.empty() && !options.truth.empty())
    throw InputError(
        {"command line", 0, "--truth", options.truth, "does not go with --input, which has a truth of its own"});
  const Recording recording = read_recording(options.input);
  const auto truth = read_truth(options.truth);
  const std::optional<nodes::foreign::StepFolder> folder = step_folder(options.steps);
  const nodes::foreign::StepFolder* const steps = pointer_to(folder);
  const std::vector<Planned> plans = all_planned(options, recording, truth, steps);
  for (const Planned& plan : plans) try_folder(plan.folder);  // before hours of driving
  std::vector<ScenarioResults> all;
  for (const Planned& plan : plans) all.push_back({plan.scenario.name, driven(options, plan, recording, steps)});
  if (options.json) {
    nlohmann::ordered_json json;
    for (std::size_t s = 0; s < plans.size(); ++s)
      json.push_back(to_json(plans[s].scenario, plans[s].seed, all[s].results));
    fmt::print("{}\n", (plans.size() == 1 ? json.front() : json).dump(2));
  } else {
    print_words(plans, all);
  }
  std::fflush(stdout);  // both streams may share one file
  bool good = true;
  for (const Planned& plan : plans) say_written(plan.folder);
  for (std::size_t s = 0; s < plans.size(); ++s) good = did_its_work(options, plans[s], all[s].results) && good;
  return good ? 0 : 1;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Drives in virtual time: logs, summary table and pictures");
  command->footer(
      "Each of several scenarios has a folder of its own, in --out if that is given.\n"
      "Examples: ttfusion run scenarios/paper_scenario1.yaml --seed 7 --out out/drive\n"
      "          ttfusion run scenarios/paper_scenario1.yaml scenarios/paper_scenario2.yaml --strategy tt");
  command->add_option("scenario", options->scenarios, "Scenario file or a shipped one's name, or several to compare")
      ->required();
  command->add_option("--strategy", options->strategy, "Only this strategy (default: all three)")
      ->check(one_of(strategy_names()));
  command->add_option("--seed", options->seed, "Seed of every random stream, instead of the scenario's");
  command->add_option("--duration", options->duration, "Seconds to drive, instead of the scenario's");
  command->add_option("--input", options->input, "Recorded observations in place of the sensor models")->check(named());
  command->add_option("--truth", options->truth, "ASAM OSI trace in place of the scenario's objects (.osi or .mcap)")
      ->check(named());
  command->add_option("-o,--out", options->out, "Folder for logs and pictures (default: out/<scenario>)")
      ->check(named());
  add_step_options(*command, options->steps);
  command->add_flag("--json", options->json, "Summary as JSON on standard output");
  command->add_flag("--no-log", options->no_log, "Write no logs (and so no pictures)");
  command->add_flag("--no-pictures", options->no_pictures, "Write logs only");
  command->callback([options, &action] {
    action = [options] {
      for (auto& scenario : options->scenarios) scenario = file_named(scenario, {kScenarios});
      return run_scenarios(*options);
    };
  });
}

}  // namespace ttf::cli::drive
