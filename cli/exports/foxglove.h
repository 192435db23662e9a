// Exports a drive for Foxglove and Lichtblick.
#pragma once

#include <string>
#include <vector>

#include "recording/exports/viewer/foxglove_export.h"
#include "recording/merge/merge.h"

namespace ttf::cli::exports {

struct FoxgloveResult {
  recording::exports::viewer::SceneCounts counts;
  std::vector<std::string> left_out;  // parts that the log lacks
  std::vector<std::string> warnings;
};

// Throws std::runtime_error if `out` cannot be written.
FoxgloveResult export_foxglove(const recording::merge::MergedLogs& drive, const std::string& out);

}  // namespace ttf::cli::exports
