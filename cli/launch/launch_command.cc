#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/drive_setup.h"
#include "cli/drive/fault_tables.h"
#include "cli/drive/real_time_outputs.h"
#include "cli/drive/run_outputs.h"
#include "cli/drive/startup_outputs.h"
#include "cli/drive/summary.h"
#include "cli/launch/drive_end.h"
#include "cli/launch/launch_live.h"
#include "cli/launch/launch_plan.h"
#include "cli/launch/launch_result.h"
#include "cli/launch/verdict.h"
#include "cli/output.h"
#include "cli/supervision/folder_lock.h"
#include "cli/supervision/launch_folder.h"
#include "cli/supervision/signal_watch.h"
#include "cli/supervision/supervisor.h"
#include "core/decimal.h"
#include "sim/drives/surroundings.h"
#include "sim/drives/traced.h"
#if TTF_WITH_DDS
#include "cli/launch/launch_virtual.h"
#endif

namespace ttf::cli::launch {
namespace {

constexpr const char* kSummary = "summary.json";
// Members of the summary that the manifest has, too.
constexpr const char* kExternal = "external_nodes";
constexpr const char* kNotInOperation = "not_in_operation_at_end";

// Returns the arguments of this process, as given.
std::vector<std::string> command_line() {
  std::vector<std::string> arguments;
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

// Prints and writes the drive's results, from the logs of the nodes that reached its end.
void report_result(const node_set::NodeSet& set, const drive::StrategyResult& result,
                   const std::optional<Verdict>& verdict, const nlohmann::ordered_json& launched,
                   const std::vector<external::Account>& accounts, const LaunchArguments& arguments) {
  const std::vector<drive::StrategyResult> results{result};
  if (!arguments.no_pictures) write_pictures(set.scenario, results, set.folder);
  nlohmann::ordered_json json = to_json(set.scenario, set.seed, results);
  json.update(launched);
  write_file(fmt::format("{}/{}", set.folder, kSummary), json.dump(2) + '\n');
  if (arguments.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n{}{}{}", sim::drives::subject_of(set.scenario), startup_text(results, set.scenario.startup.cold),
             comparison_table(results), real_time_text(result));
  if (!set.scenario.faults.empty())
    fmt::print("\n{}", drive::faults_text(name_of(set.strategy), result.faults, result.fault_free, set.cluster));
  if (!accounts.empty()) fmt::print("\n{}", table_text(accounts));
  if (verdict) fmt::print("verdict: {}\n", verdict->sentence);
}

// Reports nodes out of operation at the end and an empty comparison, in a sentence each. Returns the exit
// code: a drive fails if no node is in operation at its end, even if all processes ended well.
int report_end(const node_set::NodeSet& set, const DriveEnd& end, const drive::StrategyResult* result,
               const nlohmann::ordered_json& launched, int exit_code, supervision::LaunchFolder& folder) {
  const std::string absent = end.sentence();
  const bool failed = end.nobody && exit_code == 0;
  if (!absent.empty()) fmt::print(stderr, "{}: {}\n", failed ? "error" : "warning", absent);
  if (result != nullptr && result->summary.uses == result->summary.stale_uses)
    print_warnings(fmt::format("no current image was used from {} s on (evaluate_from): there is nothing to evaluate",
                               scaled_text(set.scenario.evaluate_from.ns, 1'000'000'000)));
  folder.set(kNotInOperation, launched.at(kNotInOperation));
  if (failed)
    folder.finish(1, absent, std::chrono::system_clock::now());
  else
    folder.write();
  return failed ? 1 : exit_code;
}

// Removes only the files of an earlier launch, which might pass for this launch's.
void remove_earlier(const std::optional<supervision::EarlierLaunch>& earlier, const LaunchPlan& plan,
                    const supervision::LaunchFolder& folder) {
  for (const supervision::NodeSpec& node : plan.nodes) folder.remove_logs(node.name);
  if (!earlier) return;
  for (const std::string& node : earlier->nodes) {
    folder.remove_logs(node);
    folder.remove(supervision::file_stem(node) + ".txt");
  }
  for (const char* const name : {kTruthLog, kSummary}) folder.remove(name);
  if (earlier->strategy.empty()) return;
  folder.remove(merged_log(earlier->strategy));
  for (const std::string& name : drive::picture_files(earlier->strategy)) folder.remove(name);
}

// `Launch` is LiveLaunch or VirtualLaunch.
template <class Launch> int run_plan(LaunchPlan plan, const LaunchArguments& arguments) {
  nlohmann::ordered_json facts{{"command", command_line()}};
  facts.update(facts_of(plan.set));
  if (plan.set.scenario.truth) fmt::print(stderr, "{}\n", sim::drives::truth_text(plan.set.scenario));
  for (const std::string& warning : {sim::drives::motion_warning(plan.set.scenario, plan.set.cluster),
                                     sim::drives::following_warning(plan.set.scenario),
                                     sim::drives::unused_sections(plan.set.scenario, {&plan.set.cluster, 1})})
    if (!warning.empty()) print_warnings(warning);
  const auto earlier = supervision::earlier_launch(plan.set.folder);
  supervision::LaunchFolder folder(plan.set.folder, std::move(facts), std::chrono::system_clock::now());
  remove_earlier(earlier, plan, folder);
  // Blocks the signals before the exchange begins a thread, which would otherwise take them.
  std::optional<supervision::SignalWatch> held_back(std::in_place);
  Launch drive(plan);
  EndWatch watch(plan.nodes.size());
  supervision::SupervisorConfig config;
  config.nodes = std::move(plan.nodes);
  config.screen = STDERR_FILENO;
  config.stop_is_success = plan.set.until_stopped;
  config.results_due = true;
  config.folder = &folder;
  std::optional<supervision::Supervisor> supervisor(std::in_place, std::move(config), watch.around(drive.hooks()));
  const int exit_code = supervisor->run().exit_code;
  const supervision::HealthTable health = supervisor->health();
  supervisor.reset();
  held_back.reset();  // from here on, signals interrupt again
  print_warnings(drive.warnings());
  plan.set.scenario.duration = drive.driven();  // the drive is judged to its real end
  const std::optional<drive::StrategyResult> result = drive.result(folder.logs());
  const drive::StrategyResult* const shown = result ? &*result : nullptr;
  std::optional<DriveEnd> end;
  if (watch.begun())
    end = drive_end(watch.nodes(plan.set.cluster, drive.states_at_end(health, shown), plan.set.externals));
  const std::vector<external::Account> accounts = drive.accounts();
  std::optional<Verdict> verdict;
  if (result && result->real_time)
    verdict = verdict_of({&plan.set.cluster, &*result->real_time, result->service, health.restarts(),
                          end ? end->sentence() : std::string(), wrongs_text(accounts)});
  const nlohmann::ordered_json launched =
      to_json(drive::LaunchFindings{end ? std::optional(end->absent) : std::nullopt, reported(accounts), verdict});
  if (!accounts.empty()) folder.set(kExternal, launched.at(kExternal));
  if (result) report_result(plan.set, *result, verdict, launched, accounts, arguments);
  std::fflush(stdout);  // both streams may share one file
  if (!end && !accounts.empty()) folder.write();
  const int code = end ? report_end(plan.set, *end, shown, launched, exit_code, folder) : exit_code;
  say_written(plan.set.folder);
  return code;
}

// A dry run has the exit code of a launch that goes well.
int run_launch(const LaunchArguments& arguments) {
  LaunchPlan plan = plan_of(arguments);
  const bool ready = supervision::all_good(plan.preflight);
  if (arguments.dry_run)
    show_plan(plan, arguments.json);
  else if (ready)
    show_duties(plan);
  else
    show_preflight(plan);
  if (!ready) return 1;
  if (arguments.dry_run) {
    supervision::FolderLock::refuse_if_held(plan.set.folder);
    try_folder(plan.set.folder);
    return 0;
  }
#if TTF_WITH_DDS
  if (plan.set.virtual_time) return run_plan<VirtualLaunch>(std::move(plan), arguments);
#endif
  return run_plan<LiveLaunch>(std::move(plan), arguments);
}

}  // namespace

void add_launch(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<LaunchArguments>();
  CLI::App* command = app.add_subcommand("launch", "A drive with a process for each node, under a supervisor");
  command->footer(
      "Example: ttfusion launch scenarios/paper_scenario1.yaml --virtual-time \\\n"
      "           --policy feature=optional --dry-run");
  add_node_set_options(*command, arguments->set);
  command
      ->add_option("--policy", arguments->policies,
                   "NODE=required (default), NODE=restart or NODE=optional; once for each node")
      ->allow_extra_args(false);
  command->add_flag("--dry-run", arguments->dry_run, "Show the plan and whether its needs are met, but start nothing");
  command
      ->add_option("-o,--out", arguments->set.out,
                   "Folder for logs, output and manifest (default: out/<scenario>/launch)")
      ->check(named());
  command->add_flag("--json", arguments->json, "Summary, or with --dry-run the plan, as JSON on standard output");
  command->add_flag("--no-pictures", arguments->no_pictures, "Draw no pictures");
  command->callback([arguments, command, &action] {
    arguments->session_given = command->count("--session") > 0;
    action = [arguments] { return run_launch(*arguments); };
  });
}

}  // namespace ttf::cli::launch
