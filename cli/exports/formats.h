// Exports of a drive that are more than one call of recording/exports. Each throws std::runtime_error if a file cannot be written.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "recording/exports/viewer/foxglove_export.h"
#include "recording/merge/merge.h"
#include "recording/osi/osi_export.h"

namespace ttf::cli::exports {

// For Foxglove and Lichtblick.
struct FoxgloveResult {
  recording::exports::viewer::SceneCounts counts;
  std::vector<std::string> left_out;  // parts that the log lacks
  std::vector<std::string> warnings;
};
FoxgloveResult export_foxglove(const recording::merge::MergedLogs& drive, const std::string& out);

// Tables and gnuplot scripts for papers. `inputs` are logs, or folders of logs, of one or several drives, or one
// experiment's folder. Creates `out` if missing. Returns the files' names. Throws InputError, too.
std::vector<std::string> export_gnuplot(const std::vector<std::string>& inputs, const std::string& out);

// Writes the drive's log and its ASAM OSI trace into one MCAP file. If it cannot be written, it does not exist.
recording::osi::OsiCounts export_osi(const recording::merge::MergedLogs& drive, const std::string& out);
// Writes a file of SensorData and one of GroundTruth into the folder; `files` becomes their names.
recording::osi::OsiCounts export_osi_files(const recording::merge::MergedLogs& drive, const std::string& folder,
                                           std::vector<std::string>& files);

// Tables for Python, R, spreadsheets and databases, by name with their rows. A table that cannot be written does not stay.
using TableRows = std::vector<std::pair<std::string, std::uint64_t>>;
// Files in the folder `out`, which is created if missing.
TableRows export_tables(const recording::merge::MergedLogs& drive, const std::string& out);
// One SQLite file.
TableRows export_sqlite(const recording::merge::MergedLogs& drive, const std::string& file);

}  // namespace ttf::cli::exports
