#include "cli/launch/launch_plan.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cli/drive/drive_setup.h"
#include "cli/launch/external/duties_text.h"
#include "cli/live_media/bus.h"
#include "cli/live_media/dds_configuration.h"
#include "cli/node_set/can_interfaces.h"
#include "cli/node_set/live_topics.h"
#include "cli/supervision/shell_text.h"
#include "core/errors.h"
#include "core/hash.h"
#include "sim/drives/step_catalog.h"

namespace ttf::cli::launch {
namespace {

std::string this_program() {
  std::error_code failure;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) throw std::runtime_error("/proc/self/exe: cannot be read: " + failure.message());
  return path.string();
}

// Parses --policy NODE=POLICY.
void set_policies(const std::vector<std::string>& texts, const schedules::model::Cluster& cluster,
                  std::vector<supervision::NodeSpec>& nodes) {
  std::map<std::string, std::string> given;
  for (const std::string& text : texts) {
    const std::size_t sign = text.rfind('=');
    const auto policy = sign == std::string::npos ? std::nullopt : supervision::policy_of(text.substr(sign + 1));
    if (!policy)
      throw InputError({"command line", 0, "--policy", text, "must be NODE=required, NODE=restart or NODE=optional"});
    const std::string name = text.substr(0, sign);
    if (!given.emplace(name, text).second)
      throw InputError({"command line", 0, "--policy", text, "must be given once for each node"});
    nodes[index_of(node_set::node_of(cluster, name, "--policy", text))].policy = *policy;
  }
}

void refuse_restart_of_external(const LaunchPlan& plan) {
  for (const supervision::NodeSpec& node : plan.nodes)
    if (node.external && node.policy == supervision::Policy::kRestart)
      throw InputError({"command line", 0, "--policy", node.name + "=restart",
                        "must be NODE=required or NODE=optional for a node of --external: the launch cannot start it"});
}

// Returns a session unique to this launch, among all launches on this machine or in this folder.
std::string new_session() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("launch-{}-{}", getpid(), std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

external::DutyPlaces places_of(const LaunchPlan& plan) {
  return {plan.set.cluster, plan.set.bus, plan.set.can_interfaces, plan.set.session};
}

void refuse_restart_in_virtual_time(const LaunchPlan& plan) {
  for (const supervision::NodeSpec& node : plan.nodes)
    if (plan.set.virtual_time && node.policy == supervision::Policy::kRestart)
      throw InputError({"command line", 0, "--policy", node.name + "=restart",
                        "must not be given with --virtual-time: the other nodes do not wait for a restarted one"});
}

}  // namespace

LaunchPlan plan_of(const LaunchArguments& arguments) {
  LaunchPlan plan;
  plan.set = read_node_set(arguments.set);
  if (plan.set.topics) check_topics(plan.set);
  if (!arguments.session_given) plan.set.session = new_session();
  const std::string program = this_program();
  for (const schedules::model::Node& node : plan.set.cluster.nodes) {
    supervision::NodeSpec spec;
    spec.name = node.name;
    spec.command.arguments = {program, "node", node.name};
    const std::vector<std::string> options = plan.set.options();
    spec.command.arguments.insert(spec.command.arguments.end(), options.begin(), options.end());
    plan.nodes.push_back(std::move(spec));
  }
  for (const NodeId node : plan.set.externals) {
    supervision::NodeSpec& spec = plan.nodes[index_of(node)];
    spec.external = true;
    spec.command = {};
    plan.duties.push_back(external::duties_of(plan.set.cluster, node, plan.set.time_scale_ppm));
  }
  for (std::size_t n = 0; n < plan.nodes.size(); ++n)
    if (!plan.nodes[n].external)
      nodes::foreign::check_steps(plan.set.cluster, plan.set.cluster.nodes[n], drive::pointer_to(plan.set.steps));
  set_policies(arguments.policies, plan.set.cluster, plan.nodes);
  refuse_restart_in_virtual_time(plan);
  refuse_restart_of_external(plan);
  if (plan.set.needs_dds()) live_media::check_dds_configuration();
  plan.preflight = live_media::look_at(plan.set.bus, node_set::private_cans(plan.set.cluster, plan.set.can_interfaces));
  plan.preflight.insert(plan.preflight.begin(), {plan.set.cluster.file, true, "is consistent", {}});
  return plan;
}

nlohmann::ordered_json facts_of(const node_set::NodeSet& set) {
  nlohmann::ordered_json facts{
      {"version", TTF_VERSION},
      {"scenario", {{"name", set.scenario.name}, {"file", set.file}, {"hash", hex_hash(set.scenario.text)}}},
      {"cluster", {{"name", set.cluster.name}, {"file", set.cluster.file}, {"hash", hex_hash(set.cluster.text)}}},
      {"strategy", name_of(set.strategy)},
      {"seed", set.seed},
      {"bus", set.bus.text()},
      {"virtual_time", set.virtual_time},
      {"time_scale", static_cast<double>(set.time_scale_ppm) * 1e-6},
      {"duration_s", set.scenario.duration.seconds()},
      {"folder", set.folder}};
  if (set.scenario.truth) facts["truth"] = {{"file", set.scenario.truth->name}, {"hash", set.scenario.truth->hash}};
  return facts;
}

void show_preflight(const LaunchPlan& plan) {
  fmt::print(stderr, "{}", supervision::text_of(plan.preflight));
  const std::string_view way_out = plan.set.bus.medium->way_out;
  if (!way_out.empty() && !supervision::all_good(plan.preflight)) fmt::print(stderr, "{}\n", way_out);
}

void show_duties(const LaunchPlan& plan) {
  for (const external::Duties& duties : plan.duties)
    fmt::print(stderr, "\n{}\n", external::text_of(duties, places_of(plan)));
}

void show_plan(const LaunchPlan& plan, bool as_json) {
  if (!as_json) {
    show_preflight(plan);
    show_duties(plan);
    for (const supervision::NodeSpec& node : plan.nodes)
      if (!node.external) fmt::print("{}\n", supervision::shell_text(node.command.arguments));
    return;
  }
  nlohmann::ordered_json json = facts_of(plan.set);
  json["preflight"] = supervision::json_of(plan.preflight);
  for (const supervision::NodeSpec& node : plan.nodes)
    if (!node.external)
      json["nodes"].push_back(
          {{"name", node.name}, {"policy", name_of(node.policy)}, {"command", node.command.arguments}});
    else
      json["nodes"].push_back({{"name", node.name}, {"policy", name_of(node.policy)}, {"external", true}});
  for (std::size_t i = 0; i < plan.set.externals.size(); ++i)
    json["nodes"][index_of(plan.set.externals[i])]["must_send"] = external::json_of(plan.duties[i], places_of(plan));
  fmt::print("{}\n", json.dump(2));
}

}  // namespace ttf::cli::launch
