// What a launch has looked at before it starts anything, such as whether the bus is there: in words and as JSON. What a
// bus runs over its live medium looks at (cli/live_media/live_media.h).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ttf::cli::supervision {

// One thing that was looked at.
struct PreflightItem {
  std::string what;  // "vcan0"
  bool good = true;
  std::string how;                    // "is not there"
  std::vector<std::string> commands;  // that mend it, to be given as root; none where none is known
};

bool all_good(const std::vector<PreflightItem>& items);
// One line per item, its commands below it.
std::string text_of(const std::vector<PreflightItem>& items);
nlohmann::ordered_json json_of(const std::vector<PreflightItem>& items);

}  // namespace ttf::cli::supervision
