// The libraries that a cluster names as steps, and the folder that the command line allows for them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/ids.h"
#include "core/time.h"
#include "nodes/foreign/call.h"
#include "nodes/foreign/ttfusion_step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::foreign {

// A shared library with a step's four functions (ttfusion_step.h).
struct Library {
  decltype(&ttf_step_create) create = nullptr;
  decltype(&ttf_step_run) run = nullptr;
  decltype(&ttf_step_destroy) destroy = nullptr;
};

// Loads the file, which must be a library of this program's version. A process loads it once, and keeps it until its own
// end: threads and exit handlers of the library may outlive its steps. `place` names the task. Throws InputError.
Library load_library(const std::string& path, const Finding& place, const CallTerms& terms);

struct StepFolder {
  static constexpr Duration kUsualLimit = Duration::milliseconds(10'000);

  std::string path;
  Duration limit = kUsualLimit;  // for one call, by the wall
};

// Makes each step of libraries once, as a drive does before it begins: of all nodes, or of the nodes that the process or its
// children have. Without a folder these nodes may name no library. Throws InputError.
void check_steps(const schedules::model::Cluster& cluster, const StepFolder* folder);
void check_steps(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
                 const StepFolder* folder);

// Returns the libraries' names with the hashes of their contents, by name, but not those that only the nodes `without` name:
// these are not simulated. Throws InputError if one cannot be read.
std::vector<std::pair<std::string, std::string>> library_hashes(const schedules::model::Cluster& cluster,
                                                                const StepFolder* folder,
                                                                const std::vector<NodeId>& without = {});

}  // namespace ttf::nodes::foreign
