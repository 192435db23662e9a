// summary.json, which `run` and `launch` write, and print with --json. The table in summary.cc has all members that are no
// measures (evaluation/measures). A value that is not finite becomes null.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/drive/launch_findings.h"
#include "cli/drive/run_outputs.h"
#include "keys/summary/table.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::drive {

nlohmann::ordered_json to_json(const sim::drives::Scenario& scenario, std::uint64_t seed,
                               const std::vector<StrategyResult>& results);
// Returns the members that a launch adds.
nlohmann::ordered_json to_json(const LaunchFindings& launch);

// Returns all members, in the order of the file.
std::vector<ttf::keys::summary::Member> summary_members();

}  // namespace ttf::cli::drive
