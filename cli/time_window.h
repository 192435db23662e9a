// The time window of a diagram, or of a capture compared with a schedule, from the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>

#include "core/time.h"

namespace ttf::cli {

// --from and --to as typed, in seconds.
struct TimeWindowOptions {
  std::optional<std::string> from, to;
};

// Adds both options to the command; returns --from and --to.
std::pair<CLI::Option*, CLI::Option*> add_time_window(CLI::App& command, TimeWindowOptions& options,
                                                      const std::string& from_help, const std::string& to_help);

// In true time; each end is absent if it was not given.
struct TimeWindow {
  std::optional<TrueTime> from, to;

  TrueTime begin() const { return from.value_or(TrueTime{}); }
};

// Throws InputError for a time outside 0..10^9 s, and for a time window that ends before it begins.
TimeWindow time_window(const TimeWindowOptions& options);

}  // namespace ttf::cli
