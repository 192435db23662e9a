// `schedule sequence`: the sequence of detections that fills a frame, and the intervals between them.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/commands.h"

namespace ttf::cli::schedule {

// Adds the command below `schedule`.
void add_sequence(CLI::App& schedule, Action& action);

}  // namespace ttf::cli::schedule
