// `schedule check --medium can-fd:1M/5M`: does the schedule hold where its frames travel on such a CAN?
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "schedules/model/cluster.h"

namespace ttf::cli::schedule {

struct MediumArguments {
  std::optional<std::string> medium;  // nothing: not asked for
  std::optional<std::string> time_scale;
};
void add_medium_arguments(CLI::App& command, MediumArguments& arguments);

// Of a medium that was asked for: prints what does not hold, and the time scale at which all does; returns the exit
// code. Throws InputError for what is no medium.
int check_on_medium(const schedules::model::Cluster& cluster, const MediumArguments& arguments, bool json);

}  // namespace ttf::cli::schedule
