// `schedule synthesize`: schedules that the program makes. Each way to say what is wanted has options of its own.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/commands.h"

namespace ttf::cli::schedule {

// Adds the command below `schedule`.
void add_synthesize(CLI::App& schedule, Action& action);

}  // namespace ttf::cli::schedule
