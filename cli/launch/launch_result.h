// What becomes of the logs of a node set: one log of the run, and what tables and pictures are made of.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "cli/node_set/node_set.h"
#include "recording/records/records.h"

namespace ttf::cli::launch {

// In the set's folder: what the nodes' logs are merged into, and in real time the truth.
inline std::string merged_log(std::string_view strategy) { return std::string(strategy) + ".mcap"; }
inline constexpr const char* kTruthLog = "truth.mcap";

// A log that cannot be read at all, of a node that was killed before it had written anything, is left out with a
// warning.
std::vector<std::string> readable_logs(const std::vector<std::string>& paths);

// Merges the logs, at least one, into STRATEGY.mcap in the set's folder, and judges the drive; `others` hear the
// records, too. The outcome is left as it is made.
drive::StrategyResult merged_result(const node_set::NodeSet& set, const std::vector<std::string>& logs,
                                    const std::vector<recording::records::Sink*>& others = {});

}  // namespace ttf::cli::launch
