// Merges a node set's logs into the drive's log, and judges the drive for tables and pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "cli/node_set/node_set.h"
#include "recording/records/records.h"

namespace ttf::cli::launch {

// Files in the set's folder: the merged log, and in real time the truth.
inline std::string merged_log(std::string_view strategy) { return std::string(strategy) + ".mcap"; }
inline constexpr const char* kTruthLog = "truth.mcap";

// Leaves out, with a warning, any unreadable log: its node may have been killed before it wrote.
std::vector<std::string> readable_logs(const std::vector<std::string>& paths);

// Merges the logs, at least one, into STRATEGY.mcap in the set's folder, and judges the drive. `others`
// receive the records, too. The outcome keeps its defaults.
drive::StrategyResult merged_result(const node_set::NodeSet& set, const std::vector<std::string>& logs,
                                    const std::vector<recording::records::Sink*>& others = {});

}  // namespace ttf::cli::launch
