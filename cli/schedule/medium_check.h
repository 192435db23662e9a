// `schedule check --medium can-fd:1M/5M`: checks whether the schedule holds with its frames on such a CAN.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "schedules/model/cluster.h"

namespace ttf::cli::schedule {

struct MediumArguments {
  std::optional<std::string> medium;  // no value: not given
  std::optional<std::string> time_scale;
};
void add_medium_arguments(CLI::App& command, MediumArguments& arguments);

// Prints the slots that do not hold on the given medium, and the time scale at which all hold; returns the
// exit code. Throws InputError for an invalid medium.
int check_on_medium(const schedules::model::Cluster& cluster, const MediumArguments& arguments, bool json);

}  // namespace ttf::cli::schedule
