// Exports a drive as an ASAM OSI trace.
#pragma once

#include <string>
#include <vector>

#include "recording/merge/merge.h"
#include "recording/osi/osi_export.h"

namespace ttf::cli::exports {

// Writes the drive's log and the trace into one MCAP file. Throws std::runtime_error if it cannot be written; then the
// file does not exist.
recording::osi::OsiCounts export_osi(const recording::merge::MergedLogs& drive, const std::string& out);

// Writes a file of SensorData and one of GroundTruth into the folder; `files` becomes their names. Throws
// std::runtime_error.
recording::osi::OsiCounts export_osi_files(const recording::merge::MergedLogs& drive, const std::string& folder,
                                           std::vector<std::string>& files);

}  // namespace ttf::cli::exports
