// Checks before a launch starts anything, such as whether the bus is there, in words and as JSON. Each live
// medium makes its own checks (cli/live_media/live_media.h).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ttf::cli::supervision {

// The result of one check.
struct PreflightItem {
  std::string what;  // "vcan0"
  bool good = true;
  std::string how;                    // "is not there"
  std::vector<std::string> commands;  // the remedy, for root; empty if unknown
};

bool all_good(const std::vector<PreflightItem>& items);
// Returns one line per item, its commands below it.
std::string text_of(const std::vector<PreflightItem>& items);
nlohmann::ordered_json json_of(const std::vector<PreflightItem>& items);

}  // namespace ttf::cli::supervision
