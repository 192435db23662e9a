// Words from the scenario that is attached to a log.
#pragma once

#include <string>

#include "core/time.h"
#include "recording/merge/merge.h"

namespace ttf::report::drive {

struct ScenarioWords {
  std::string description, file, text;
  TrueTime judged_from{};
  Duration duration{};  // by the file; a drive may be given another one
};

// Returns empty words if the log has no scenario, or a damaged one.
ScenarioWords scenario_in(const recording::merge::MergedLogs& log);

}  // namespace ttf::report::drive
