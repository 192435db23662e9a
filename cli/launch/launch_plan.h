// What a launch is going to do, as the command line says it: which processes, and whether what they need is there.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/node_set/node_set.h"
#include "cli/supervision/preflight.h"
#include "cli/supervision/supervisor.h"

namespace ttf::cli::launch {

struct LaunchArguments {
  node_set::NodeSetArguments set;
  std::vector<std::string> policies;
  bool dry_run = false;
  bool json = false;
  bool no_pictures = false;
  bool session_given = false;
};

// What is going to be started: one process per node of the cluster, in its order.
struct LaunchPlan {
  node_set::NodeSet set;
  std::vector<supervision::NodeSpec> nodes;
  std::vector<supervision::PreflightItem> preflight;
};
// Throws InputError for what is refused; what is only not there is in the preflight.
LaunchPlan plan_of(const LaunchArguments& arguments);

// For the manifest, and the plan as JSON.
nlohmann::ordered_json facts_of(const node_set::NodeSet& set);

// --dry-run: commands alone on standard output, so that a shell can take them; words on standard error.
void show_plan(const LaunchPlan& plan, bool as_json);
// What is not ready, and how it is made so.
void show_preflight(const LaunchPlan& plan);

}  // namespace ttf::cli::launch
