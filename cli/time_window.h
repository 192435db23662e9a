// The time window of a diagram, or of a capture compared with a schedule, from the command line.
#pragma once

#include <optional>

#include "core/time.h"

namespace ttf::cli {

// In true time; `to` is absent for the log's end or a default length.
struct TimeWindow {
  TrueTime from{};
  std::optional<TrueTime> to;
};

// Converts seconds, negative if not given. Throws InputError for an impossible time (not a number, or beyond
// 30 years) and for a time window that ends before it begins.
TimeWindow time_window(double from_s, double to_s);

}  // namespace ttf::cli
