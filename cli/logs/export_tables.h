// Exports a drive as tables for Python, R and spreadsheets.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "recording/merge/merge.h"

namespace ttf::cli::logs {

// Creates the folder `out` if missing. Returns the files' names with their rows. Throws std::runtime_error if one cannot be
// written; then those of this call do not stay.
std::vector<std::pair<std::string, std::uint64_t>> export_tables(const recording::merge::MergedLogs& drive,
                                                                 const std::string& out);

}  // namespace ttf::cli::logs
