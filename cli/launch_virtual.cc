#include "cli/launch_virtual.h"

#include <fmt/format.h>

#include <filesystem>

#include "cli/drive_setup.h"
#include "cli/launch_session.h"
#include "cli/node_drive.h"
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

StrategyResult VirtualLaunch::result(const std::vector<std::string>& logs) const {
  std::vector<std::string> there;
  for (const std::string& log : logs)
    if (std::filesystem::exists(log)) there.push_back(log);
  StrategyResult result;
  result.strategy = set_.strategy;
  result.cluster = set_.cluster;
  result.outcome = outcome_;
  const recording::MergedLogs merged(there);
  for (const std::string& warning : merged.warnings()) fmt::print(stderr, "warning: {}\n", warning);
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
