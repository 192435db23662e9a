// A drive's descriptions, as its log has them attached.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/merge/merge.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::logs {

struct Attached {
  std::optional<sim::drives::Scenario> scenario;
  std::optional<schedules::model::Cluster> cluster;
};

// A description that cannot be read is absent, with a warning that begins with `without`.
Attached attached_to(const recording::merge::MergedLogs& drive, const std::string& without,
                     std::vector<std::string>& warnings);

}  // namespace ttf::cli::logs
