// The timing of sensors that a replay gives to strategies: from the configuration, otherwise from the recording.
#pragma once

#include <optional>
#include <vector>

#include "core/time.h"
#include "fusion/strategies/strategy.h"
#include "recording/replay/config.h"
#include "recording/replay/recorded_lists.h"

namespace ttf::recording::replay {

// Returns the longest delay of a list, by sensor; zero for a sensor without lists.
std::vector<Duration> longest_delays(const RecordedLists& recorded);

// Returns a period such that all `times` (ascending) lie within a quarter of it around the grid from the first
// one. Grid instants may lack a time. Returns nullopt for fewer than three times and for irregular ones.
std::optional<Duration> regular_period(const std::vector<GlobalTime>& times);

// Returns whether the sensor has observations by range.
bool measures_ranges(const RecordedLists& recorded, SensorId sensor);

// Returns the timings by sensor. The worst delay is the configuration's, otherwise the longest in the recording.
// Scheduled instants, for TT and for clones, need a period in the configuration or a regular recording. Throws
// InputError if TT would have no sensor's instants, and so wait for none. Also throws it if the strategy cannot
// fuse late lists as configured (fusion::late_refusal()).
std::vector<fusion::strategies::SensorTiming> sensor_timings(const RecordedLists& recorded, const ReplayConfig& config,
                                                             fusion::strategies::StrategyKind strategy);

}  // namespace ttf::recording::replay
