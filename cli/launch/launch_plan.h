// The plan of a launch, from the command line: its processes, and the state of their prerequisites.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/launch/external/duties.h"
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

// The processes to start: one per node of the cluster, in its order. External nodes have none.
struct LaunchPlan {
  node_set::NodeSet set;
  std::vector<supervision::NodeSpec> nodes;
  std::vector<external::Duties> duties;  // one for each of set.externals
  std::vector<supervision::PreflightItem> preflight;
};
// Throws InputError for an invalid command line; a missing prerequisite is only in the preflight.
LaunchPlan plan_of(const LaunchArguments& arguments);

// Returns the facts for the manifest and for the plan as JSON.
nlohmann::ordered_json facts_of(const node_set::NodeSet& set);

// Shows --dry-run: only commands on standard output, for a shell; words on standard error.
void show_plan(const LaunchPlan& plan, bool as_json);
// Shows what external nodes must send, on standard error.
void show_duties(const LaunchPlan& plan);
// Shows missing prerequisites and their remedies.
void show_preflight(const LaunchPlan& plan);

}  // namespace ttf::cli::launch
