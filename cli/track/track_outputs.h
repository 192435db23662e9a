// What `track` tells of a replay: a table for people, JSON for scripts. Nothing in it differs from run to run.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "replay/replay.h"

namespace ttf::cli::track {

struct TrackResult {
  std::string strategy;
  std::vector<std::string> sensors;
  replay::ReplayAccount account;
  std::size_t damaged = 0;  // rows left out
};

std::string track_table(const TrackResult& result);
nlohmann::ordered_json to_json(const TrackResult& result);

}  // namespace ttf::cli::track
