// The results of `track`: a table for people, JSON for scripts. Equal input gives equal output.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/track/scan_lists.h"
#include "cli/track/track_judge.h"
#include "cli/track/track_lives.h"
#include "recording/replay/replay.h"
#include "recording/replay/verdict.h"

namespace ttf::cli::track {

struct TrackResult {
  std::string strategy;
  std::vector<std::string> sensors;
  recording::replay::ReplayAccount account;
  std::size_t damaged = 0;  // number of damaged rows, which are left out
  recording::replay::ReplayVerdict verdict;
  std::optional<TrackAccuracy> accuracy;  // only for a recording with truth
  std::optional<ScanAccount> scans;       // only for scans
  std::optional<LivesSummary> lives;      // only for scans
};

std::string track_table(const TrackResult& result);
nlohmann::ordered_json to_json(const TrackResult& result);

}  // namespace ttf::cli::track
