// The results of `track`: a table for people, JSON for scripts. Equal input gives equal output.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "replay/replay.h"
#include "replay/verdict.h"

namespace ttf::cli::track {

struct TrackResult {
  std::string strategy;
  std::vector<std::string> sensors;
  replay::ReplayAccount account;
  std::size_t damaged = 0;  // number of damaged rows, which are left out
  replay::ReplayVerdict verdict;
};

std::string track_table(const TrackResult& result);
nlohmann::ordered_json to_json(const TrackResult& result);

}  // namespace ttf::cli::track
