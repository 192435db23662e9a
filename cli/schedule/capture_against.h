// `schedule check --against CAPTURE`: checks whether captured frames obey the schedule.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/time_window.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::schedule {

struct CaptureArguments {
  std::string file;  // empty: not given
  std::string channels = "AB";
  TimeWindowOptions window;
};
void add_capture_arguments(CLI::App& command, CaptureArguments& arguments);

// Prints every contradiction and a summary; returns the exit code. Throws InputError for an unreadable capture.
int check_against_capture(const schedules::model::Cluster& cluster, const CaptureArguments& arguments, bool json);

}  // namespace ttf::cli::schedule
