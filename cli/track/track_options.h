// The options of `track` that name a sensor: SENSOR=VALUE.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/paper_size.h"
#include "recording/replay/config.h"
#include "recording/replay/recorded_lists.h"

namespace ttf::cli::track {

struct TrackOptions {
  std::string observations, ego, config, format = "csv", strategy, seed = "1", out, picture;
  std::vector<std::string> noise;        // SENSOR:WHAT=SIGMA
  std::vector<std::string> worst_delay;  // SENSOR=DURATION
  std::vector<std::string> period;       // SENSOR=DURATION
  std::vector<std::string> delay;        // SENSOR=DURATION or SENSOR=LEAST..MOST
  std::size_t shuffle = 1;
  std::optional<std::int64_t> frame;  // the one in the picture
  PaperSizeOptions paper;
  bool predict = false, skip_damaged = false, json = false;
};

// Applies the options about sensors to the configuration. Throws InputError with the option, the value and
// the allowed values; also for a sensor that is not in the configuration. The last of several --worst-delay,
// --period or --noise counts.
void apply_sensor_options(const TrackOptions& options, recording::replay::ReplayConfig& config);
recording::replay::SimulatedArrivals simulated_arrivals(const TrackOptions& options,
                                                        const recording::replay::ReplayConfig& config);

}  // namespace ttf::cli::track
