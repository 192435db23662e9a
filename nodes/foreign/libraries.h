// The libraries that a cluster names as steps, and the folder that the command line allows for them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::foreign {

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
