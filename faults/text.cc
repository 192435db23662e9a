// Writes faults in the form that load.cc reads: the keys of their kinds, in exact units.
#include <fmt/format.h>

#include "faults/parameters.h"
#include "faults/plan.h"

namespace ttf::faults {

std::vector<std::pair<std::string_view, std::string>> keys_of(const Fault& fault,
                                                              const schedules::model::Cluster& cluster) {
  std::vector<std::pair<std::string_view, std::string>> keys;
  write_parameters(fault, cluster, keys);
  return keys;
}

std::string entry_of(const Fault& fault, const schedules::model::Cluster& cluster) {
  std::string text = fmt::format("{{kind: {}", name_of(fault.kind));
  if (fault.node != kNoNode) text += fmt::format(", node: {}", cluster.node(fault.node).name);
  for (const auto& [key, value] : keys_of(fault, cluster)) text += fmt::format(", {}: {}", key, value);
  return text + '}';
}

}  // namespace ttf::faults
