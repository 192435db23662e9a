// The ways of `schedule check`. Each prints its findings and returns the exit code: 1 if one does not hold. Each throws InputError.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/time_window.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::schedule {

// `--can-errors 10ms`: each list's longest time on its CAN without and with errors; `apart` is the least time between two
// errors on a CAN, as text. Returns 1 if a list may be queued before the last one of its message is sent.
int check_can_errors(const schedules::model::Cluster& cluster, const std::string& apart, bool json);

// `--against CAPTURE`: every contradiction of captured frames to the schedule, and a summary.
struct CaptureArguments {
  std::string file;  // empty: not given
  std::string channels = "AB";
  TimeWindowOptions window;
};
void add_capture_arguments(CLI::App& command, CaptureArguments& arguments);
int check_against_capture(const schedules::model::Cluster& cluster, const CaptureArguments& arguments, bool json);

// `--medium can-fd:1M/5M`: the slots that do not hold with their frames on such a CAN, and the time scale at which all hold.
struct MediumArguments {
  std::optional<std::string> medium;  // no value: not given
  std::optional<std::string> time_scale;
};
void add_medium_arguments(CLI::App& command, MediumArguments& arguments);
int check_on_medium(const schedules::model::Cluster& cluster, const MediumArguments& arguments, bool json);

// `--task-set FILE.csv`: responses and chains of bare tasks and messages.
int check_task_set(const std::string& file, bool json);

}  // namespace ttf::cli::schedule
