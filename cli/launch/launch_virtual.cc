#include "cli/launch/launch_virtual.h"

#include <utility>

#include "cli/launch/drive_end.h"
#include "cli/launch/launch_result.h"
#include "cli/node_set/node_drive.h"
#include "cli/node_set/session.h"

namespace ttf::cli::launch {

VirtualLaunch::VirtualLaunch(const LaunchPlan& plan) : set_(plan.set), exchange_(session_of(plan.set, true)) {}

supervision::Hooks VirtualLaunch::hooks() {
  supervision::Hooks hooks;
  hooks.on_gone = [this](std::size_t node, const supervision::Ending&, bool) {
    exchange_.announce_gone(static_cast<NodeId>(node));
  };
  hooks.on_done = [this](std::size_t, const nlohmann::json& facts) { node_set::add_outcome(outcome_, facts); };
  return hooks;
}

std::optional<drive::StrategyResult> VirtualLaunch::result(const std::vector<std::string>& logs) const {
  const std::vector<std::string> readable = readable_logs(logs);
  if (readable.empty()) return std::nullopt;
  drive::StrategyResult result = merged_result(set_, readable);
  result.outcome = outcome_;
  return result;
}

std::vector<std::string> VirtualLaunch::states_at_end(const supervision::HealthTable&,
                                                      const drive::StrategyResult* result) const {
  if (result == nullptr) return std::vector<std::string>(set_.cluster.nodes.size());
  return launch::states_at_end(set_.cluster, set_.scenario.startup.cold, result->startup);
}

}  // namespace ttf::cli::launch
