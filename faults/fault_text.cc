// Writes faults in the form that load.cc reads: the keys of their kinds, in exact units.
#include <fmt/format.h>

#include "core/decimal.h"
#include "faults/parameters.h"
#include "faults/plan.h"

namespace ttf::faults {

std::vector<std::pair<std::string_view, std::string>> keys_of(const Fault& fault,
                                                              const schedules::model::Cluster& cluster) {
  std::vector<std::pair<std::string_view, std::string>> keys;
  write_parameters(
      fault, cluster, [](Duration time) { return fmt::format("{} ns", time.ns); }, keys);
  return keys;
}

std::string entry_of(const Fault& fault, const schedules::model::Cluster& cluster) {
  std::string text = fmt::format("{{kind: {}", name_of(fault.kind));
  if (fault.node != kNoNode) text += fmt::format(", node: {}", cluster.node(fault.node).name);
  std::vector<std::pair<std::string_view, std::string>> keys;
  write_parameters(fault, cluster, duration_text, keys);
  for (const auto& [key, value] : keys) text += fmt::format(", {}: {}", key, value);
  return text + '}';
}

}  // namespace ttf::faults
