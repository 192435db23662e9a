// Recorded observations through a strategy and its tracker, as a fusion node would: list by list as they arrive,
// online. What arrives is accepted and fused at once, as far as the strategy lets it; while it holds lists back, it is
// asked again at every instant at which one of them may be let go. After the last arrival the replay goes on until
// nothing is held.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/strategies/strategy.h"
#include "recording/rows/track_rows.h"
#include "replay/recorded_lists.h"

namespace ttf::replay {

// What became of the lists of one sensor.
struct SensorAccount {
  std::uint64_t lists = 0, observations = 0;
  std::uint64_t in_order = 0, late = 0, too_old = 0, duplicates = 0;  // one of these for every list
  std::uint64_t held = 0;                                             // lists that were not let go as they arrived
  Duration longest_hold, longest_delay;
};

struct ReplayAccount {
  std::vector<SensorAccount> sensors;  // by SensorId
  std::uint64_t tracks = 0;            // confirmed ones, each counted once
  std::uint64_t rows = 0;              // handed to the sink
};

// The tracks after a fusion that took something in: confirmed ones, not given up.
using TrackSink = std::function<void(ttf::GlobalTime known, std::span<const ttf::fusion::tracks::TrackView> tracks)>;

struct ReplaySetup {
  fusion::strategies::StrategyKind strategy = fusion::strategies::StrategyKind::kAdva;
  fusion::config::TrackerConfig tracker;
  std::vector<fusion::strategies::SensorTiming> timings;  // by SensorId
  bool predict = false;  // tracks predicted to the instant of the fusion, not as of the newest measurement
};

ReplayAccount replay(const RecordedLists& recorded, const ReplaySetup& setup, const TrackSink& sink);

// `classes`: those of the recorded lists.
recording::rows::TrackRow track_row_of(const fusion::tracks::TrackView& view, GlobalTime known,
                                       const std::vector<std::string>& classes);

}  // namespace ttf::replay
