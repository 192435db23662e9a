// What a replay may promise the strategies of its sensors: what the configuration says, else what the recording shows.
#pragma once

#include <optional>
#include <vector>

#include "core/time.h"
#include "fusion/strategies/strategy.h"
#include "replay/config.h"
#include "replay/recorded_lists.h"

namespace ttf::replay {

// By sensor: the longest that a list was under way. Zero for a sensor without lists.
std::vector<Duration> longest_delays(const RecordedLists& recorded);

// A period from the first of `times` (ascending) on which all of them lie within a quarter of it, also where some of
// its instants have none; nothing for less than three, and for what is not regular.
std::optional<Duration> regular_period(const std::vector<GlobalTime>& times);

// Whether nothing else was measured.
bool only_positions(const RecordedLists& recorded);

// By sensor. The worst delay is the longest seen unless the configuration has one. Instants are scheduled for TT, and
// for clones, where the configuration has a period, or else the recording is regular. Throws InputError where TT is
// asked for and no sensor's instants are known, for it would wait for none, and where the strategy cannot take late
// lists in as the configuration says (fusion::late_refusal()).
std::vector<fusion::strategies::SensorTiming> sensor_timings(const RecordedLists& recorded, const ReplayConfig& config,
                                                             fusion::strategies::StrategyKind strategy);

}  // namespace ttf::replay
