// What `ttfusion run` says of a drive whose nodes started up or changed their state on the way.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/drive/run_outputs.h"

namespace ttf::cli::drive {

// Which nodes became active in which cycle, when (true time), and why, a table a strategy, one for
// those that do not differ in it; empty where no drive has any to tell. `cold`: the drives began with a start-up;
// else it is of nodes that left the running cluster, and maybe came back.
std::string startup_text(const std::vector<StrategyResult>& results, bool cold);
// The same of one drive: a list with an entry per node.
nlohmann::ordered_json startup_json(const StrategyResult& result);

}  // namespace ttf::cli::drive
