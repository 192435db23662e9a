// The tables of `ttfusion run` about nodes that started up or changed their state during a drive.
#pragma once

#include <string>

#include "cli/drive/run_outputs.h"

namespace ttf::cli::drive {

// Returns a table per strategy, one for all strategies with equal tables: the nodes that became active, with
// cycle, instant (true time) and cause. Empty without changes of state. `cold` means that the drives began
// with a start-up; otherwise the tables have nodes that left the running cluster.
std::string startup_text(const std::vector<StrategyResult>& results, bool cold);

// Returns "" if a node became active. Otherwise a sentence names the nodes. Drives that began integrated return "".
std::string never_started(const StrategyResult& result, bool cold);

}  // namespace ttf::cli::drive
