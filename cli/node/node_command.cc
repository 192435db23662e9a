#include "cli/node/node_command.h"

#include <algorithm>
#include <memory>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/supervision/launch_folder.h"
#include "core/errors.h"

namespace ttf::cli::node {
namespace {

struct NodeArguments {
  std::string name;
  node_set::NodeSetArguments set;
  bool json = false;
};

int run_node(const NodeArguments& arguments) {
  NodeOptions options;
  options.set = read_node_set(arguments.set);
  options.node = node_set::node_of(options.set.cluster, arguments.name, "name", arguments.name);
  if (std::ranges::find(options.set.externals, options.node) != options.set.externals.end())
    throw InputError({"command line", 0, "--external", *arguments.set.external, "must not name the node itself"});
  nodes::foreign::check_steps(options.set.cluster, options.set.cluster.node(options.node),
                              drive::pointer_to(options.set.steps));
  options.log = options.set.folder + "/" + supervision::file_stem(arguments.name) + ".mcap";
  options.json = arguments.json;
#if TTF_WITH_DDS
  if (options.set.virtual_time) return run_node_virtual(options);
#endif
  return run_node_live(options);
}

}  // namespace

void add_node(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<NodeArguments>();
  CLI::App* command =
      app.add_subcommand("node", "One node as a process, started by launch, or by hand on other machines");
  command->footer(
      "Examples: ttfusion node fusion scenarios/paper_scenario1.yaml --virtual-time --out out/nodes\n"
      "          ttfusion node fusion scenarios/paper_scenario1.yaml --bus socketcan:can0,can1 \\\n"
      "            --can laser_can=can2 --can camera_can=can3 --can observation_can=can4 \\\n"
      "            --start-at $(($(date +%s) + 10)) --time-scale 4");
  command->add_option("name", arguments->name, "Name of the node in the cluster file")->required();
  add_node_set_options(*command, arguments->set);
  command->add_option("--start-at", arguments->set.start_at,
                      "Start of the drive, in UTC seconds since 1970, for nodes without a supervisor; real time only");
  command->add_flag("--rejoin", arguments->set.rejoin,
                    "Begin cold and integrate into the running cluster; real time only");
  command->add_option("--host", arguments->set.host,
                      "Name of this machine's clock, the same for all its processes and for no others (default: the "
                      "machine's name); real time only");
  command->add_option("-o,--out", arguments->set.out, "Folder for the node's log (default: out/<scenario>/launch)")
      ->check(named());
  command->add_flag("--json", arguments->json, "Outcome as JSON on standard output");
  command->callback([arguments, &action] { action = [arguments] { return run_node(*arguments); }; });
}

}  // namespace ttf::cli::node
