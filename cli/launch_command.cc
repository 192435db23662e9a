#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/can_interfaces.h"
#include "cli/commands.h"
#include "cli/drive_setup.h"
#include "cli/fault_tables.h"
#include "cli/launch_live.h"
#include "cli/launch_result.h"
#include "cli/launch_virtual.h"
#include "cli/live_topics.h"
#include "cli/output.h"
#include "cli/real_time_outputs.h"
#include "cli/run_outputs.h"
#include "cli/startup_outputs.h"
#include "cli/launch/preflight.h"
#include "cli/launch/run_folder.h"
#include "cli/launch/shell_text.h"
#include "cli/launch/signal_watch.h"
#include "cli/launch/supervisor.h"
#include "cli/node_set.h"
#include "core/errors.h"

namespace ttf::cli {
namespace {

constexpr const char* kSummary = "summary.json";

struct LaunchArguments {
  NodeSetArguments set;
  std::vector<std::string> policies;
  bool dry_run = false;
  bool json = false;
  bool no_pictures = false;
  bool session_given = false;
};

// What is going to be started: one process per node of the cluster, in its order.
struct LaunchPlan {
  NodeSet set;
  std::vector<launch::NodeSpec> nodes;
  std::vector<launch::PreflightItem> preflight;
};

std::string this_program() {
  std::error_code failure;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) throw std::runtime_error("/proc/self/exe: cannot be read: " + failure.message());
  return path.string();
}

// As it was given.
std::vector<std::string> command_line() {
  std::vector<std::string> arguments;
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

// --policy NODE=POLICY
void set_policies(const std::vector<std::string>& texts, const schedules::Cluster& cluster,
                  std::vector<launch::NodeSpec>& nodes) {
  std::map<std::string, std::string> given;
  for (const std::string& text : texts) {
    const std::size_t sign = text.rfind('=');
    const auto policy = sign == std::string::npos ? std::nullopt : launch::policy_of(text.substr(sign + 1));
    if (!policy)
      throw InputError({"command line", 0, "--policy", text, "must be NODE=required, NODE=restart or NODE=optional"});
    const std::string name = text.substr(0, sign);
    if (!given.emplace(name, text).second)
      throw InputError({"command line", 0, "--policy", text, "must be given once for each node"});
    nodes[index_of(node_of(cluster, name))].policy = *policy;
  }
}

// Of this launch alone, whatever else is launched on this machine or in this folder.
std::string new_session() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("launch-{}-{}", getpid(), std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

LaunchPlan plan_of(const LaunchArguments& arguments) {
  LaunchPlan plan;
  plan.set = read_node_set(arguments.set);
  if (plan.set.topics) check_topics(plan.set);
  if (!arguments.session_given) plan.set.session = new_session();
  const std::string program = this_program();
  for (const schedules::Node& node : plan.set.cluster.nodes) {
    launch::NodeSpec spec;
    spec.name = node.name;
    spec.command.arguments = {program, "node", node.name};
    const std::vector<std::string> options = plan.set.options();
    spec.command.arguments.insert(spec.command.arguments.end(), options.begin(), options.end());
    plan.nodes.push_back(std::move(spec));
  }
  set_policies(arguments.policies, plan.set.cluster, plan.nodes);
  plan.preflight = launch::look_at(plan.set.bus, private_cans(plan.set.cluster, plan.set.can_interfaces));
  plan.preflight.insert(plan.preflight.begin(), {plan.set.cluster.file, true, "is consistent", {}});
  return plan;
}

nlohmann::ordered_json facts_of(const NodeSet& set) {
  return {{"version", TTF_VERSION},
          {"scenario", {{"name", set.scenario.name}, {"file", set.file}, {"hash", hex_hash(set.scenario.text)}}},
          {"cluster", {{"name", set.cluster.name}, {"file", set.cluster.file}, {"hash", hex_hash(set.cluster.text)}}},
          {"strategy", nodes::name_of(set.strategy)},
          {"seed", set.seed},
          {"bus", set.bus.text()},
          {"virtual_time", set.virtual_time},
          {"time_scale", static_cast<double>(set.time_scale_ppm) * 1e-6},
          {"duration_s", set.scenario.duration.seconds()},
          {"folder", set.folder}};
}

// Commands alone on standard output, so that a shell can take them; words on standard error.
int show_plan(const LaunchPlan& plan, bool as_json) {
  if (!as_json) {
    fmt::print(stderr, "{}", launch::text_of(plan.preflight));
    for (const launch::NodeSpec& node : plan.nodes) fmt::print("{}\n", launch::shell_text(node.command.arguments));
    return 0;
  }
  nlohmann::ordered_json json = facts_of(plan.set);
  json["preflight"] = launch::json_of(plan.preflight);
  for (const launch::NodeSpec& node : plan.nodes)
    json["nodes"].push_back(
        {{"name", node.name}, {"policy", name_of(node.policy)}, {"command", node.command.arguments}});
  fmt::print("{}\n", json.dump(2));
  return 0;
}

// What came of the drive, from the logs of those who got to its end; nothing where nobody has a log.
template <class Launch>
void tell_result(const NodeSet& set, const Launch& drive, const launch::RunFolder& folder,
                 const LaunchArguments& arguments) {
  const std::optional<StrategyResult> result = drive.result(folder.logs());
  if (!result) return;
  const std::vector<StrategyResult> results{*result};
  if (!arguments.no_pictures) write_pictures(set.scenario, results, set.folder);
  const nlohmann::ordered_json json = to_json(set.scenario, set.seed, results);
  write_file(fmt::format("{}/{}", set.folder, kSummary), json.dump(2) + '\n');
  if (arguments.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n{}{}{}", set.scenario.description, startup_text(results, set.scenario.startup.cold),
             comparison_table(results), real_time_text(*result));
  if (!set.scenario.faults.empty())
    fmt::print("\n{}", faults_text(nodes::name_of(set.strategy), result->faults, result->fault_free, set.cluster));
}

// What an earlier launch left, so that nobody takes it for this one's; and nothing else that is in the folder.
void remove_earlier(const std::optional<launch::EarlierLaunch>& earlier, const LaunchPlan& plan,
                    const launch::RunFolder& folder) {
  for (const launch::NodeSpec& node : plan.nodes) folder.remove_logs(node.name);
  if (!earlier) return;
  for (const std::string& node : earlier->nodes) {
    folder.remove_logs(node);
    folder.remove(launch::file_stem(node) + ".txt");
  }
  for (const char* const name : {kTruthLog, kSummary}) folder.remove(name);
  if (earlier->strategy.empty()) return;
  folder.remove(merged_log(earlier->strategy));
  for (const std::string& name : picture_files(earlier->strategy)) folder.remove(name);
}

// `Launch`: LiveLaunch or VirtualLaunch.
template <class Launch>
int run_plan(LaunchPlan plan, const LaunchArguments& arguments) {
  nlohmann::ordered_json facts{{"command", command_line()}};
  facts.update(facts_of(plan.set));
  const auto earlier = launch::earlier_launch(plan.set.folder);
  launch::RunFolder folder(plan.set.folder, std::move(facts), std::chrono::system_clock::now());
  remove_earlier(earlier, plan, folder);
  // Before the exchange begins a thread, which would take signals else.
  std::optional<launch::SignalWatch> held_back(std::in_place);
  Launch drive(plan.set);
  launch::SupervisorConfig config;
  config.nodes = std::move(plan.nodes);
  config.screen = STDERR_FILENO;
  config.folder = &folder;
  const launch::Outcome outcome = launch::Supervisor(std::move(config), drive.hooks()).run();
  held_back.reset();   // what comes now may be interrupted as ever
  print_warnings(drive.warnings());
  tell_result(plan.set, drive, folder, arguments);
  std::fflush(stdout);   // both may go to one file
  fmt::print(stderr, "written to {}\n", plan.set.folder);
  return outcome.exit_code;
}

int run_launch(const LaunchArguments& arguments) {
  LaunchPlan plan = plan_of(arguments);
  if (arguments.dry_run) return show_plan(plan, arguments.json);
  if (!launch::all_good(plan.preflight)) {
    fmt::print(stderr, "{}", launch::text_of(plan.preflight));
    return 1;
  }
  if (!plan.set.virtual_time) return run_plan<LiveLaunch>(std::move(plan), arguments);
  for (const launch::NodeSpec& node : plan.nodes)
    if (node.policy == launch::Policy::kRestart)
      throw InputError({"command line", 0, "--policy", node.name + "=restart",
                        "must not be given with --virtual-time: nobody would wait for the node to catch up"});
  return run_plan<VirtualLaunch>(std::move(plan), arguments);
}

}  // namespace

void add_launch(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<LaunchArguments>();
  CLI::App* command = app.add_subcommand("launch", "The node set as separate processes, supervised");
  command->footer(
      "Example: ttfusion launch scenarios/paper_scenario1.yaml --virtual-time --policy feature=optional --dry-run");
  add_node_set_options(*command, arguments->set);
  command
      ->add_option("--policy", arguments->policies,
                   "NODE=required (default), NODE=restart or NODE=optional; for each node once")
      ->allow_extra_args(false);
  command->add_flag("--dry-run", arguments->dry_run, "Only say what would be started, and whether the bus is there");
  command->add_option("--out", arguments->set.out,
                      "Folder of the run: logs, output, manifest (default: out/<scenario>/launch)");
  command->add_flag("--json", arguments->json, "Summary, or with --dry-run the plan, as JSON on standard output");
  command->add_flag("--no-pictures", arguments->no_pictures, "Leave logs and tables only");
  command->callback([arguments, command, &action] {
    arguments->session_given = command->count("--session") > 0;
    action = [arguments] { return run_launch(*arguments); };
  });
}

}  // namespace ttf::cli
