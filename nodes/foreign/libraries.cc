#include "nodes/foreign/libraries.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "core/file_bytes.h"
#include "core/hash.h"
#include "nodes/foreign/foreign_step.h"
#include "schedules/model/ports.h"

namespace ttf::nodes::foreign {

void check_steps(const schedules::model::Cluster& cluster, const StepFolder* folder) {
  for (const schedules::model::Node& node : cluster.nodes) check_steps(cluster, node, folder);
}

void check_steps(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
                 const StepFolder* folder) {
  for (const schedules::model::Task& task : node.tasks)
    if (schedules::model::names_library(task.step)) ForeignStep(cluster, node, task, folder);
}

std::vector<std::pair<std::string, std::string>> library_hashes(const schedules::model::Cluster& cluster,
                                                                const StepFolder* folder,
                                                                const std::vector<NodeId>& without) {
  std::set<std::string> names;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (std::ranges::find(without, n, [](NodeId node) { return index_of(node); }) != without.end()) continue;
    for (const schedules::model::Task& task : cluster.nodes[n].tasks)
      if (schedules::model::names_library(task.step)) names.insert(task.step);
  }
  std::vector<std::pair<std::string, std::string>> hashes;
  if (folder == nullptr) return hashes;
  for (const std::string& name : names) hashes.emplace_back(name, hex_hash(read_file(folder->path + "/" + name)));
  return hashes;
}

}  // namespace ttf::nodes::foreign
