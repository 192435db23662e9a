// The price of a smaller age in a plan, written as a picture or a table.
#pragma once

#include <string>

#include "cli/schedule/planning/judges.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::cli::schedule::planning {

// Throws InputError if the name has no ending of a picture or a table.
void check_trade_off_path(const std::string& path);

// Writes candidates, the front of slots and ages, and in a picture what binds the schedule that was made.
void write_trade_off(const schedules::synthesis::plan::Plan& plan,
                     const schedules::synthesis::instants::Synthesis& made, const PlanJudges& judges,
                     const std::string& path);

}  // namespace ttf::cli::schedule::planning
