// What a launch by the wall clock leaves behind beside what every run does: how late processes and frames were.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/drive/run_outputs.h"

namespace ttf::cli::drive {

// Tables in words: of each node how late its process was woken up, next to the machine's own floor; how late frames
// left and came; what was not in its time, or never came; what its medium counted; and how well the clocks agreed and
// how old used measurements were. Empty in virtual time.
std::string real_time_text(const StrategyResult& result);
// The same, for `"real_time"` in summary.json; null in virtual time.
nlohmann::ordered_json real_time_json(const StrategyResult& result);

}  // namespace ttf::cli::drive
