#include "cli/launch_virtual.h"

#include <fmt/format.h>

#include <utility>

#include "cli/drive_setup.h"
#include "cli/launch_session.h"
#include "cli/node_drive.h"
#include "cli/output.h"
#include "core/errors.h"
#include "nodes/catalog.h"
#include "recording/merge.h"
#include "recording/records/tee.h"

namespace ttf::cli {

VirtualLaunch::VirtualLaunch(const NodeSet& set) : set_(set), exchange_(session_of(set, true)) {}

launch::Hooks VirtualLaunch::hooks() {
  launch::Hooks hooks;
  hooks.on_gone = [this](std::size_t node, const launch::Ending&, bool) {
    exchange_.announce_gone(static_cast<NodeId>(node));
  };
  hooks.on_done = [this](std::size_t, const nlohmann::json& facts) { add_outcome(outcome_, facts); };
  return hooks;
}

std::optional<StrategyResult> VirtualLaunch::result(const std::vector<std::string>& logs) const {
  StrategyResult result;
  result.strategy = set_.strategy;
  result.cluster = set_.cluster;
  result.outcome = outcome_;
  std::vector<recording::StoredLog> stored;
  for (const std::string& log : logs) {
    try {
      stored.emplace_back(log);
    } catch (const InputError& error) {   // of a node that was killed before it had written anything
      for (const Finding& finding : error.findings()) print_warnings(finding.sentence());
    }
  }
  if (stored.empty()) return std::nullopt;
  const recording::MergedLogs merged(std::move(stored));
  print_warnings(merged.warnings());
  result.log_path = fmt::format("{}/{}.mcap", set_.folder, nodes::name_of(set_.strategy));
  recording::write_merged(merged, result.log_path);
  result.content_hash = recording::ContentHash::text(merged.content_hash().value());
  DriveJudge judge(set_.scenario, set_.cluster);
  records::Tee tee(judge.sinks());
  merged.read(tee);
  judge.finish(result);
  return result;
}

}  // namespace ttf::cli
