// The tables of a launch in real time, beside those of every drive: the lateness of processes and frames.
#pragma once

#include <string>

#include "cli/drive/run_outputs.h"

namespace ttf::cli::drive {

// Returns tables for people: the lateness of wake-ups beside the machine's own floor, the lateness of frames,
// timing problems and losses, the media's counts, the clocks' agreement and the ages of used measurements. Empty in
// virtual time.
std::string real_time_text(const StrategyResult& result);

}  // namespace ttf::cli::drive
