#include "cli/node/node_command.h"

#include <memory>

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
  options.node = node_set::node_of(options.set.cluster, arguments.name);
  options.log = options.set.folder + "/" + supervision::file_stem(arguments.name) + ".mcap";
  options.json = arguments.json;
  return options.set.virtual_time ? run_node_virtual(options) : run_node_live(options);
}

}  // namespace

void add_node(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<NodeArguments>();
  CLI::App* command =
      app.add_subcommand("node", "One node's process: what launch starts, and what is started by hand on other hosts");
  command->footer(
      "Examples: ttfusion node fusion scenarios/paper_scenario1.yaml --virtual-time --out out/nodes\n"
      "          ttfusion node fusion scenarios/paper_scenario1.yaml --bus socketcan:can0,can1 \\\n"
      "            --can laser_can=can2 --can camera_can=can3 --can observation_can=can4 \\\n"
      "            --start-at $(($(date +%s) + 10)) --time-scale 4");
  command->add_option("name", arguments->name, "The node, by its name in the cluster file")->required();
  add_node_set_options(*command, arguments->set);
  command->add_option("--start-at", arguments->set.start_at,
                      "UTC seconds since 1970 at which all nodes begin, where they have no supervisor; real time only");
  command->add_flag("--rejoin", arguments->set.rejoin,
                    "Begin cold and integrate into the cluster that runs; real time only");
  command->add_option("--host", arguments->set.host,
                      "Name of the clock that this process goes by, the same for all on one host and for no others "
                      "(default: the host's name); real time only");
  command->add_option("--out", arguments->set.out, "Folder for the node's log (default: out/<scenario>/launch)")
      ->check(kNamed);
  command->add_flag("--json", arguments->json, "What came of it as JSON on standard output");
  command->callback([arguments, &action] { action = [arguments] { return run_node(*arguments); }; });
}

}  // namespace ttf::cli::node
