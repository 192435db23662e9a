// Logs from the command line. The folder of a drive stands for its logs.
#pragma once

#include <string>
#include <vector>

#include "recording/merge/merge.h"

namespace ttf::cli::logs {

// Returns the files. A folder's are those that its summary names. Without a summary they are all (*.mcap). Throws InputError
// for a folder without any, and for a file of another kind.
std::vector<std::string> log_files(const std::vector<std::string>& inputs);

// Merges the logs of each drive into one, and prints the merge's warnings.
std::vector<recording::merge::MergedLogs> drives_in(const std::vector<std::string>& inputs);
// Does the same for the logs of one drive. Throws InputError if a folder holds several.
recording::merge::MergedLogs drive_in(const std::vector<std::string>& inputs);

}  // namespace ttf::cli::logs
