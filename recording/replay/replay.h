// Sends recorded lists through a strategy and its tracker, as a fusion node would: online, list by list as they
// arrive. Each list is accepted and fused at once if the strategy permits. While the strategy holds lists, it is
// asked again at every instant that may release one. After the last arrival the replay continues until no list
// is held.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/strategies/strategy.h"
#include "recording/replay/recorded_lists.h"
#include "recording/rows/track_rows.h"

namespace ttf::recording::replay {

// Counts the fates of one sensor's lists.
struct SensorAccount {
  std::uint64_t lists = 0, observations = 0;
  std::uint64_t in_order = 0, late = 0, too_old = 0, duplicates = 0;  // exactly one of these for every list
  std::uint64_t held = 0;                                             // lists not released on arrival
  Duration longest_hold, longest_delay;
};

struct ReplayAccount {
  std::vector<SensorAccount> sensors;  // by SensorId
  std::uint64_t tracks = 0;            // confirmed tracks, each counted once
  std::uint64_t rows = 0;              // passed to the sink
};

// Receives the tracks after each fusion of a list: the confirmed ones that were not given up.
using TrackSink = std::function<void(ttf::GlobalTime known, std::span<const ttf::fusion::tracks::TrackView> tracks)>;

struct ReplaySetup {
  fusion::strategies::StrategyKind strategy = fusion::strategies::StrategyKind::kAdva;
  fusion::config::TrackerConfig tracker;
  std::vector<fusion::strategies::SensorTiming> timings;  // by SensorId
  bool predict = false;  // predict tracks to the fusion instant, not only to the newest measurement
};

ReplayAccount replay(const RecordedLists& recorded, const ReplaySetup& setup, const TrackSink& sink);

// `classes` are those of the recorded lists.
recording::rows::TrackRow track_row_of(const fusion::tracks::TrackView& view, GlobalTime known,
                                       const std::vector<std::string>& classes);

}  // namespace ttf::recording::replay
