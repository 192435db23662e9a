// The use that `run --input` made of its recording, for people and for scripts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/drive/run_outputs.h"
#include "drives/played_recording.h"

namespace ttf::cli::drive {

// Returns the sentences of all strategies, those of equal ones once; empty without a recording.
std::string recordings_text(const std::vector<StrategyResult>& results);
nlohmann::ordered_json recording_json(const drives::RecordingUse& use);

}  // namespace ttf::cli::drive
