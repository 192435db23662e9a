// What the scenario that is attached to a log says of itself.
#pragma once

#include <string>

#include "core/time.h"
#include "recording/merge/merge.h"

namespace ttf::report::run {

struct ScenarioWords {
  std::string description, file, text;
  TrueTime judged_from{};
};

// Empty where the log has none, or a damaged one.
ScenarioWords scenario_in(const recording::merge::MergedLogs& log);

}  // namespace ttf::report::run
