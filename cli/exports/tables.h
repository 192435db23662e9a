// Exports a drive as tables for Python, R, spreadsheets and databases.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "recording/merge/merge.h"

namespace ttf::cli::exports {

using TableRows = std::vector<std::pair<std::string, std::uint64_t>>;

// Creates the folder `out` if missing. Returns the files' names with their rows. Throws std::runtime_error if one cannot be
// written; then those of this call do not stay.
TableRows export_tables(const recording::merge::MergedLogs& drive, const std::string& out);

// Writes one SQLite file. Returns the tables' names with their rows. Throws std::runtime_error if it cannot be written; then
// it does not stay.
TableRows export_sqlite(const recording::merge::MergedLogs& drive, const std::string& file);

}  // namespace ttf::cli::exports
