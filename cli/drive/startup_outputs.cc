#include "cli/drive/startup_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/counted.h"
#include "report/drawing/tables.h"

namespace ttf::cli::drive {

std::string startup_text(const std::vector<StrategyResult>& results, bool cold) {
  std::vector<std::pair<std::string, std::string>> tables;  // with the names of their strategies
  for (const StrategyResult& result : results) {
    if (result.startup.empty()) continue;
    report::drawing::Table table({"node", cold ? "powered\non [ms]" : "powered on\nagain [ms]",
                                  cold ? "first active\nin cycle" : "first active\nagain in cycle", "at [ms]",
                                  "in state at the end, and why"});
    table.end_in_words();
    for (const evaluation::cluster::NodeStartup& node : result.startup) {
      const bool on_flexray = !node.state.empty();
      table.add({result.cluster.node(node.node).name,
                 node.powered ? report::drawing::cell(in_ms(*node.powered), 1) : "-",
                 node.active ? fmt::format("{}", node.active->cycle) : "-",
                 node.active ? report::drawing::cell(in_ms(node.active->at), 1) : "-",
                 on_flexray ? fmt::format("{}: {}", node.state, node.why) : "not on FlexRay"});
    }
    const std::string name(name_of(result.strategy)), body = table.text();
    const auto same =
        std::find_if(tables.begin(), tables.end(), [&](const auto& other) { return other.second == body; });
    if (same != tables.end())
      same->first += ", " + name;
    else
      tables.emplace_back(name, body);
  }
  std::string text;
  for (const auto& [names, body] : tables)
    text += fmt::format("{} with {}\n{}\n", cold ? "start-up" : "changes of state", names, body);
  return text;
}

std::string never_started(const StrategyResult& result, bool cold) {
  const bool started = std::ranges::any_of(
      result.startup, [](const evaluation::cluster::NodeStartup& node) { return node.active.has_value(); });
  if (!cold || started) return "";
  std::vector<std::string> names;
  for (const schedules::model::Node& node : result.cluster.nodes)
    if (node.flexray) names.push_back(node.name);
  return fmt::format("with {} no node ever became active: {}", name_of(result.strategy), joined(names));
}

}  // namespace ttf::cli::drive
