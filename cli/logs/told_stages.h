// The latency by stage of a drive, from its log and the cluster that is attached to it.
#pragma once

#include <string>
#include <vector>

#include "recording/merge/merge.h"
#include "report/drive/stages.h"

namespace ttf::cli::logs {

// Returns nothing if the log has no sound cluster; a warning tells of one that cannot be read.
std::vector<report::drive::ToldStages> told_stages(const recording::merge::MergedLogs& drive,
                                                   std::vector<std::string>& warnings);

}  // namespace ttf::cli::logs
