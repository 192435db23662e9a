// The parameters of FlexRay that a cluster file may leave out: other keys determine them. The rules are the
// equations of annex B.4 (2.1 Rev. A), or the bound of a constraint where one value is the obvious choice. docs/
// cluster_files.md has them as a table.
//
// A rule takes the parameters that the file has, and those of earlier rules. It has no value where these are not given
// either, or do not divide.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "schedules/analysis/parameter_bounds.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

using Absent = std::set<std::string, std::less<>>;  // names of parameters

// In the units of the model: picoseconds for scaled parameters (parameter_table.h).
struct GlobalRule {
  std::string_view parameter;
  std::string_view derivation;
  std::optional<std::int64_t> (*value)(const model::GlobalParameters&, const Absent&);
};

// A controller among the others. Clock rules need the cluster's parameters alone, the others all nodes and frames.
struct Controller {
  const model::Cluster& cluster;
  NodeId id;
  analysis::Terms terms;
};
struct NodeRule {
  std::string_view parameter;
  std::string_view derivation;
  std::optional<std::int64_t> (*value)(const Controller&, const Absent&);
};

// In the order of their use.
std::span<const GlobalRule> global_rules();
std::span<const NodeRule> clock_rules();
std::span<const NodeRule> node_rules();
bool is_derived(std::string_view parameter);

}  // namespace ttf::schedules::file
